#pragma once

#include <vector>

#include "core/kernel/interfaces/topology.h"
#include "core/numerics/mesh/grain.h"

namespace drape {

/// For each triangle a number of its flat piece, from 0 in the order of their first triangles: edges that are
/// no seams connect it.
std::vector<int> flat_pieces(const TriangleMesh& mesh, const Topology& topology);

/// For each triangle the number of its connected part, from 0 in the order of their first triangles.
std::vector<int> connected_parts(const TriangleMesh& mesh);

/// cut_directions of flat pieces: as they are drawn, from y (for x), u or the mesh's own directions.
Positions flat_directions(const TriangleMesh& mesh, GrainAxis along, const Eigen::VectorXd& degrees);

/// Lengths in space over lengths in texture coordinates [m]: by areas, and along u and along v.
struct UvLength {
  double whole = 0, along_u = 0, along_v = 0;

  /// Measured on the triangles that are marked and have an area in texture coordinates.
  static UvLength of(const TriangleMesh& mesh, const std::vector<char>& marked);
};

/// Whether two lengths are nearer than a placement in space may stretch them: a tenth.
bool similar_lengths(double a, double b);

/// Makes texture coordinates of flat pieces those of a picture: from 0 to 1 along the longest extent. Returns
/// the length of one [m], 0 of other texture coordinates.
double scale_to_picture(TriangleMesh& mesh);

}  // namespace drape
