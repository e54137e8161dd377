#pragma once

namespace drape {

/// Barrier and friction parameters that all collisions of a contact model share (docs/theory/method.md,
/// section 6).
struct BarrierParameters {
  double dhat = 1e-3;                         ///< d̂ [m]
  double stiffness = 1;                       ///< κ [Pa]
  double friction_smoothing_distance = 1e-4;  ///< ε_v h, below which friction is smoothed [m]
  bool stiffness_is_fixed = true;             ///< false if κ may be raised for larger forces
};

}  // namespace drape
