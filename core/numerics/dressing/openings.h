#pragma once

#include <vector>

#include "core/kernel/interfaces/level.h"

namespace drape {

/// A closed border of a sewn cloth, as a cuff, a hem or a neckline.
struct Opening {
  std::vector<int> half_edges;                       ///< of the cloth's triangles, one after the other
  double length = 0;                                 ///< [m]
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< mean of its vertices [m]
  bool passed = false;                               ///< whether a part of the body passes through it
};

/// The openings of a cloth at x (n×3) [m], the longest first. A sheet, a connected part of the cloth with one
/// border and no seam, has none.
///
/// A part of the body passes through a closed curve if it is separated from the rest of its connected
/// component, both at least 2 cm large, once the edges are taken away whose signed crossings with the fan of
/// triangles from the curve's mean point do not cancel. A component that they do not separate passes too, as
/// an arm whose hand has grown together with the hip. An opening is passed if that holds of its border, or of
/// a curve 3, 6, 9, … cm from it along the cloth, since a hem may end below the feet and a cuff beyond the
/// hand. The search ends where such a curve meets another border, splits or vanishes, or is longer than 1.1
/// times the border and 0.6 of the distance from it: there the tube that leads to the opening ends.
std::vector<Opening> openings_of(const Level& level, const Positions& x, const TriangleMesh& body);

}  // namespace drape
