#pragma once

#include "core/numerics/hierarchy/hierarchy.h"

namespace drape {

/// Factors on the stiffness of a level's hinges [1] with which its mesh resists bending about every axis as
/// the finest level's does. Folds bend at edges, so a mesh is stiffer to some directions than to others, and
/// levels that are not refinements of each other differ in that: a one-way grid resists folds along its
/// diagonals three times as much as other folds, a Delaunay triangulation of the same cloth does not.
Eigen::VectorXd matched_folds(const Hierarchy& hierarchy, int level);

}  // namespace drape
