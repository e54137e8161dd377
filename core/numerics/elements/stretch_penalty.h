#pragma once

#include <memory>
#include <vector>

#include "core/kernel/interfaces/energy.h"
#include "core/numerics/elements/stretch_kernel.h"

namespace drape {

/// φ(σ) = weight (σ - 1)².
struct StretchPenaltyLaw {
  static constexpr int constants = 1;  ///< weight, κ_a V [J]
  static constexpr bool convex = false;

  template <class T>
  static T value(const T& s1, const T& s2, const T* constants) {
    return constants[0] * ((s1 - 1.0) * (s1 - 1.0) + (s2 - 1.0) * (s2 - 1.0));
  }
  template <class T>
  static StretchSlopes<T> slopes(const T& s1, const T& s2, const T* constants) {
    const T second = 2.0 * constants[0];
    return {second * (s1 - 1.0), second * (s2 - 1.0), second, second, second};
  }
};

/// Stretch penalty A(x) = κ Σ_t V_t Σ_i (σ_{t,i} - 1)² [J] over the flagged triangles, V rest area ×
/// thickness [m], κ [Pa]. It pulls triangles that violate a strain limit back within it
/// (docs/theory/method.md, section 4; Zhang et al. 2022, section 4.3). `flags` has one entry for each
/// triangle. Throws std::runtime_error if a flagged one has no rest area.
std::unique_ptr<BoundEnergy> make_stretch_penalty(const Level& level, double thickness, double stiffness,
                                                  const std::vector<char>& flags);

}  // namespace drape
