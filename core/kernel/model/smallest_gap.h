#pragma once

#include <limits>
#include <string>

#include "core/kernel/mesh/triangle_mesh.h"

namespace drape {

/// The smallest gap of a state and the parameters of the barrier that acts on it.
struct SmallestGap {
  std::string between;  ///< "cloth triangle 12 and ball: sphere"; empty without a gap below d̂
  double gap = std::numeric_limits<double>::infinity();  ///< [m]
  double dhat = 0;                                       ///< d̂, below which the barrier acts [m]
  double stiffness = 0;                                  ///< κ of the barrier [Pa]
};

/// Optional interface of a BoundContact whose barrier has a d̂ and a stiffness.
class SmallestGapProvider {
 public:
  virtual ~SmallestGapProvider() = default;
  virtual SmallestGap smallest_gap(const Positions& x) const = 0;
};

}  // namespace drape
