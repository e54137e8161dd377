#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/kernel/interfaces/energy.h"

namespace drape {

/// A triangle and its largest principal stretch.
struct StretchedTriangle {
  int triangle = 0;    ///< of the level
  double stretch = 0;  ///< σ₁ [1]
};

/// "triangle 12, stretched to 1.0712 (limit 1.0608)"
std::string to_string(const StretchedTriangle& stretched, double limit);

/// What BoundEnergy::stretch_limit gives for an energy that keeps the stretch of triangles below a limit.
class StretchLimited {
 public:
  virtual ~StretchLimited() = default;
  virtual double limit() const = 0;  ///< s [1]
  /// Triangles that violate the limit at x (σ₁ ≥ s, or NaN), by rising index.
  virtual std::vector<StretchedTriangle> violations(const Positions& x) const = 0;
  /// An energy with this limit and a stretch_limit and max_step of its own, restricted to the triangles that
  /// `excluded` does not flag (one entry a triangle of the level). Safe refinement uses it as long as some
  /// triangles violate the limit.
  virtual std::unique_ptr<BoundEnergy> restricted(const std::vector<char>& excluded) const = 0;
};

/// Names the triangles that violate a stretch limit among `energies`, at most `most_named` for each limit; ""
/// without violations.
std::string strain_limit_violations(const std::vector<const BoundEnergy*>& energies, const Positions& x,
                                    std::size_t most_named);

}  // namespace drape
