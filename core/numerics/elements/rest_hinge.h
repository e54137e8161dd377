#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/kernel/interfaces/level.h"

namespace drape {

/// rest_vectors of a surface in space, and of flat pieces.
inline std::array<Eigen::Vector3d, 3> vectors_in_space(const Level& level, Eigen::Index hinge) {
  const auto vertices = level.hinges.row(hinge);
  const Positions& x = level.rest.vertices;
  std::array<Eigen::Vector3d, 3> d;
  for (int i = 0; i < 3; ++i) d[i] = x.row(vertices[i + 1]) - x.row(vertices[0]);
  return d;
}
std::array<Eigen::Vector3d, 3> flat_vectors(const Level& level, Eigen::Index hinge);

/// The vectors e, u and v of a level's hinge at rest, from its vertex 0 to the others [m]. Between flat
/// pieces e has the mean of the edge's two lengths, both triangles keep their areas, and the angle is the
/// seams'.
inline std::array<Eigen::Vector3d, 3> rest_vectors(const Level& level, Eigen::Index hinge) {
  return level.rest.sewing ? flat_vectors(level, hinge) : vectors_in_space(level, hinge);
}

/// material_triangles and rest_hinges of flat pieces.
std::vector<Eigen::Matrix<double, 8, 1>> flat_material_triangles(const Level& level);
std::vector<Eigen::Matrix<double, 8, 1>> flat_rest_hinges(const Level& level);

/// Factor on the stiffness of a hinge [1]: 1, but for seams.
double stiffness_factor(const Level& level, Eigen::Index hinge);

}  // namespace drape
