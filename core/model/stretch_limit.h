#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/model/energy.h"

namespace drape {

/// A triangle and its largest principal stretch.
struct StretchedTriangle {
  int triangle = 0;    ///< of the level
  double stretch = 0;  ///< σ₁ [1]
};

/// "triangle 12, stretched to 1.0712 (limit 1.0608)"
std::string to_string(const StretchedTriangle& stretched, double limit);

/// An optional ability of a BoundEnergy that keeps the stretch of triangles below a limit.
class StretchLimited {
 public:
  virtual ~StretchLimited() = default;
  virtual double limit() const = 0;  ///< s [1]
  /// Triangles that are not inside at x (σ₁ ≥ s, or not a number), by rising index.
  virtual std::vector<StretchedTriangle> beyond(const Positions& x) const = 0;
  /// The same limit, a StretchLimited and StepFilter too, without the triangles flagged: one entry a triangle
  /// of the level. For safe refinement, which starts with triangles that are beyond it.
  virtual std::unique_ptr<BoundEnergy> without(const std::vector<char>& skipped) const = 0;
};

/// Names what is beyond those of the energies that limit stretch, at most so many triangles; "" where none
/// is.
std::string beyond_limits(const std::vector<const BoundEnergy*>& energies, const Positions& x,
                          std::size_t most_named);

}  // namespace drape
