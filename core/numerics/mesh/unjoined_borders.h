#pragma once

#include <array>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// Whether a mesh has lost the joints of its faces: it falls into pieces of one or two triangles, and most of
/// their edges coincide with others, bit for bit.
bool is_soup(const TriangleMesh& mesh);

/// A border vertex that lies inside a border edge, whose triangle and one of the vertex's lie side by side.
struct TJunction {
  int vertex;
  std::array<int, 2> edge;
};

/// The T-junctions within each connected part of a mesh: on one side of a line its triangles have a vertex
/// that is missing on the other.
std::vector<TJunction> t_junctions(const TriangleMesh& mesh);

}  // namespace drape
