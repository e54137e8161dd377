#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/app/experiment/experiment_parameters.h"
#include "core/kernel/interfaces/level.h"
#include "core/numerics/sewing/sew_pattern.h"

namespace drape {

/// Makes flat pieces of a file's mesh, as its `rest`, `uv_unit` and `seams` say, and names them where the
/// file does not. Throws std::runtime_error with what is missing, and with what the file's texture
/// coordinates seem to be.
void sew(TriangleMesh& cloth, const ClothParameters& c);

/// The cloth of a sewing pattern's file, and the edges of its labels. Nothing, with every fault appended at
/// its place in that file, if it is none. Throws std::runtime_error without a file.
std::optional<TriangleMesh> cloth_of_pattern(const ClothParameters& c, ConfigErrors& errors,
                                             LabelEdges* labels = nullptr);

/// The number of vertices of a sewing pattern, by the outlines of its panels; none for a faulty pattern.
std::optional<double> vertices_in_outlines(const ClothParameters& c);

/// A line for each seam of a sewing pattern that takes up more than three tenths of its longer side; none for
/// other cloth and for a faulty pattern.
std::vector<std::string> gather_remarks(const ClothParameters& c);

/// The seams that sew two neighbouring edges of a panel on one line to each other, as a tuck is folded: an
/// error for each; none for a faulty pattern.
ConfigErrors tucks_in(const ClothParameters& c);

/// Finds the edges of the labels that pins and handles select. Appends the labels that a pattern has not.
void find_label_edges(const ConfigNode& source, ExperimentParameters& p, ConfigErrors& errors);

/// A line about a cloth of flat pieces, as "3 flat pieces, 2.4 m of seams, …"; "" for another cloth.
std::string sewing_text(const Level& coarsest);

}  // namespace drape
