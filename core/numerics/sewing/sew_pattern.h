#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"
#include "core/numerics/patterns/delaunay.h"
#include "core/numerics/sewing/pattern.h"

namespace drape {

/// The ends of each label's edges in the cloth, two by two.
using LabelEdges = std::map<std::string, std::vector<int>>;

/// The cloth of a pattern, and the edges of its labels: panels meshed with edges of about `edge_length` [m]
/// and joined at their seams, each vertex at the mean of the places that its panels give it, with z up. Its
/// pieces are the panels; its texture coordinates [m] have them as they are drawn, in a row. Appends every
/// fault, located in the pattern's file, and returns nothing then: outlines that cross, seams as in
/// divide_edges, seams that give the cloth one side or join more than two panels at an edge.
std::optional<TriangleMesh> sew_pattern(const Pattern& pattern, double edge_length, ConfigErrors& errors,
                                        LabelEdges* labels = nullptr);

/// Area and border of all panels together.
OutlineSize outline_size(const Pattern& pattern);

}  // namespace drape
