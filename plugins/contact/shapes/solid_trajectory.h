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
  bool is_static() const;
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

/// The trajectory of each solid. Throws std::runtime_error if number or kinds differ.
std::vector<SolidTrajectory> solid_trajectories(const std::vector<Solid>& from, const std::vector<Solid>& to);

/// Advects the rows of `reference` [m] of vertices in frictional contact with the scene's solids at x: each
/// moves with the touched points of the solids, rigidly, from the scene to `to`.
void advect_with_solids(const ShapeScene& scene, const std::vector<Solid>& to, const Positions& x,
                        Positions& reference);

}  // namespace drape::shapes
