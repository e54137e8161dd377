#pragma once

#include <array>
#include <vector>

#include "core/kernel/interfaces/level.h"

namespace drape {

/// For each vertex of one mesh in several frames the first one that is at its place in all of them.
std::vector<int> first_at_place(const std::vector<TriangleMesh>& frames);

/// Makes one vertex, at the first one's place, of those that are nearer to each other than `tolerance` [m]; 0
/// joins none. Texture coordinates stay as they are at the corners. Returns the new index of each vertex.
/// Throws std::runtime_error if hundreds of vertices on average are about as near as the tolerance.
std::vector<int> join_vertices(TriangleMesh& mesh, double tolerance);

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

/// Two border vertices at one place at rest, and how many border vertices lie on another one.
struct Coincidence {
  int first = -1, second = -1, count = 0;
};

/// The first two border vertices of a level that are less than `tolerance` [m] apart, in the order of
/// vertices; without any, the count is 0.
Coincidence coincident_border(const Level& level, double tolerance);
/// The first two border vertices of a level that are less than `tolerance` [m] apart and nearer than a tenth
/// of every edge at either of them; without any, the count is 0.
Coincidence nearly_coincident_border(const Level& level, double tolerance);

}  // namespace drape
