#pragma once

#include <limits>
#include <string>

#include "core/mesh/triangle_mesh.h"

namespace drape {

/// The smallest gap of a state, and the barrier that keeps it open.
struct SmallestGap {
  std::string between;  ///< "cloth triangle 12 and ball: sphere"; empty where nothing is within range
  double gap = std::numeric_limits<double>::infinity();  ///< [m]
  double range = 0;                                      ///< below which the barrier acts [m]
  double stiffness = 0;                                  ///< κ of the barrier [Pa]
};

/// An optional ability of a BoundContact whose barrier has a range and a stiffness.
class NamesSmallestGap {
 public:
  virtual ~NamesSmallestGap() = default;
  virtual SmallestGap smallest_gap(const Positions& x) const = 0;
};

}  // namespace drape
