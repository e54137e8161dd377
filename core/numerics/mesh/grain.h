#pragma once

#include <string>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// Where a cloth's grain is counted from: the x axis, projected into each triangle, or in flat pieces their
/// y; the texture coordinate u, or the directions that the mesh has (TriangleMesh::warp), such as those of
/// its file.
enum class GrainAxis { x, u, file };

/// The direction of warp of each triangle at rest, m×3 unit vectors in the triangles' planes: the mesh's own,
/// or along x. Where x is a triangle's normal, the next axis stands for it.
Positions warp_directions(const TriangleMesh& rest);

/// The directions of a pattern that was cut at this angle from the axis, counter-clockwise seen from each
/// triangle's front, or as flat pieces are drawn. Where texture coordinates have no area, the x axis stands
/// for u.
Positions cut_directions(const TriangleMesh& rest, GrainAxis along, double degrees);
/// With an angle for each triangle.
Positions cut_directions(const TriangleMesh& rest, GrainAxis along, const Eigen::VectorXd& degrees);

/// The first of the triangles marked in `triangles` in which the axis has no direction, and why.
std::vector<std::string> grain_faults(const TriangleMesh& rest, GrainAxis along,
                                      const std::vector<char>& triangles);

/// Directions of the coarse mesh for the four parts of each triangle, within the fine mesh's planes. Without
/// rows if there are none.
Positions split_warp(const Positions& coarse, const TriangleMesh& fine);

/// Unit vectors within the triangles' planes that are nearest to these. Throws std::runtime_error naming a
/// triangle to which its vector is normal.
Positions projected_warp(const Positions& directions, const TriangleMesh& mesh);

}  // namespace drape
