#pragma once

#include <Eigen/Core>
#include <array>

#include "core/kernel/interfaces/level.h"

namespace drape {

/// The vectors e, u and v of a level's hinge at rest, from its vertex 0 to the others [m]. Between flat
/// pieces e has the mean of the edge's two lengths, both triangles keep their areas, and the angle is the
/// seams'.
std::array<Eigen::Vector3d, 3> rest_vectors(const Level& level, Eigen::Index hinge);

/// Factor on the stiffness of a hinge [1]: 1, but for seams.
double stiffness_factor(const Level& level, Eigen::Index hinge);

}  // namespace drape
