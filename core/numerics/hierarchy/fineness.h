#pragma once

#include "core/numerics/hierarchy/hierarchy.h"

namespace drape {

/// How much finer the finest level is than a level.
struct Fineness {
  double levels = 0;  ///< halvings of edges: half the binary logarithm of the ratio of areas
  /// m, area of the finest level's triangles around each triangle over its own area [1]; empty: 4^-levels for
  /// all of them.
  Eigen::VectorXd areas;
  Eigen::VectorXd folds;  ///< matched_folds of the level; empty where `areas` is: all are 1

  /// Not explicit: a number of regular refinements stands for the fineness that they make.
  Fineness(double regular_levels) : levels(regular_levels) {}
  /// The fineness above a level of a hierarchy, by the operators there.
  static Fineness of(const Hierarchy& hierarchy, int level);

  /// h factors by which edges are shorter on the finest level than a level's hinges, over their mean 2^levels
  /// [1]; empty without `areas`.
  Eigen::VectorXd relative_lengths(const Level& level) const;
};

}  // namespace drape
