#pragma once

#include <string>
#include <vector>

#include "plugins/contact/shapes/separation.h"
#include "plugins/contact/shapes/shape_scene.h"

namespace drape {

/// How a solid comes from one place and size to another: its parameters change linearly over [0, 1], and
/// so do the angles that it is turned by.
class SolidWay {
 public:
  SolidWay(const Solid& from, const Solid& to);

  const std::string& name() const { return to_.name; }
  bool is_still() const;
  /// The triangle's gap at the start; some value above the range [m] for most that are farther away.
  double gap(const Corners& triangle, double range) const;
  /// The part of the way on which a triangle at rest stays apart by `kept` [m]; 0 if that is not positive.
  double advance(const Corners& triangle, double kept, int rounds) const;

 private:
  Solid at(double t) const;
  double advance_plane(const Corners& triangle, double kept) const;

  const Solid &from_, &to_;
  double bend_, reach_;  // of the solid's points: |p''| at most, |p(t) - p(0)| at most [m]
};

/// The way of each solid. Throws std::runtime_error if they are not as many, of the same kinds.
std::vector<SolidWay> ways_of(const std::vector<Solid>& from, const std::vector<Solid>& to);

/// Moves the rows of `from`, where displacements count from, of the vertices that are in contact, with
/// friction, at x with a scene's solids as the points that they touch move when those go to `to`, rigidly.
void carry_with_solids(const ShapeScene& scene, const std::vector<Solid>& to, const Positions& x,
                       Positions& from);

}  // namespace drape
