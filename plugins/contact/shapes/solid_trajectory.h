#pragma once

#include <string>
#include <vector>

#include "plugins/contact/shapes/separation.h"
#include "plugins/contact/shapes/shape_scene.h"

namespace drape::shapes {

/// The motion of a solid between two states: its parameters, rotation angles included, change linearly over
/// [0, 1].
class SolidTrajectory {
 public:
  /// Keeps references to both.
  SolidTrajectory(const Solid& from, const Solid& to);

  const std::string& name() const { return to_.name; }
  /// The triangle's gap at the start [m]. Beyond d̂ it may be a lower bound above d̂.
  double gap(const Corners& triangle, double dhat) const;
  /// The part of the motion that keeps the gap to a static triangle at least `min_gap` [m]; 0 if min_gap is
  /// not positive.
  double advance(const Corners& triangle, double min_gap, int max_iterations) const;

 private:
  Solid at(double t) const;
  double advance_plane(const Corners& triangle, double min_gap) const;

  const Solid &from_, &to_;
  double acceleration_bound_, displacement_bound_;  // of the solid's points: |p''|, |p(t) - p(0)| [m]
};

/// The trajectories of those solids that move, of equally many. Throws std::runtime_error if a kind differs.
std::vector<SolidTrajectory> moving_solids(const std::vector<Solid>& from, const std::vector<Solid>& to);

/// The displacement [m] of a solid's point p as the solid moves rigidly from one placement to the other. A
/// half-space turns by the smallest angle between its normals.
Eigen::Vector3d displacement_with(const Solid& from, const Solid& to, const Eigen::Vector3d& p);

}  // namespace drape::shapes
