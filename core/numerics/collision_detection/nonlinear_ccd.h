#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "core/kernel/interfaces/energy.h"

namespace drape {

/// A plane that separates two convex primitives: they lie on the two sides of a slab of this width along the
/// normal.
struct SeparatingPlane {
  Eigen::Vector3d normal;
  double separation;  ///< [m]
};

/// Largest t in [0, 1] up to which a convex primitive at rest keeps `min_gap` [m] from another whose points
/// move on curves p(t) with |p''| ≤ acceleration_bound [m]. `widest(t)` is a separating plane at t, as wide
/// as possible. `separation(n, t)` is the separation along another normal, negative if it does not separate.
///
/// Conservative advancement along a curved trajectory (compare `nonlinear_ccd` of ipc-toolkit): between t and
/// t + s a point is within acceleration_bound s²/8 of its chord. A slab that is wider than min_gap plus that
/// at both ends therefore keeps min_gap in between. Every normal gives a safe result, however inaccurate. The
/// result is shorter than necessary only if `max_iterations` do not suffice.
template <class Widest, class Separation>
double nonlinear_ccd(const Widest& widest, const Separation& separation, double min_gap,
                     double acceleration_bound, int max_iterations) {
  constexpr double tolerance = 0.02;  // a separation this little above min_gap counts as min_gap
  constexpr double min_step = 1e-12;  // of t; no progress beyond round-off
  double t = 0, next_step = 1;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const SeparatingPlane plane = widest(t);
    if (!(plane.separation > (1 + tolerance) * min_gap)) return t;
    double step = std::min(next_step, 1 - t);
    while (!(std::min(plane.separation, separation(plane.normal, t + step)) -
                 acceleration_bound * step * step / 8 >=
             min_gap)) {
      step *= 0.5;
      if (step < min_step) return t;
    }
    t += step;
    if (t >= 1) return 1;
    next_step = 4 * step;
  }
  return t;
}

/// The largest collision-free step of kinematic obstacles, which leaves a minimum gap: a tenth of d̂ [m], or
/// most of `smallest_gap` [m], the smallest one before it. An obstacle that pressed on and took a large part
/// of small gaps would take whatever the cloth gains, and gaps would shrink to zero.
/// `advance(min_gap, max_iterations)` gives the largest step that leaves min_gap [m].
///
/// A full step is accepted if it leaves nine tenths of the minimum gap. Other steps are shortened to leave
/// all of it, so a shortened step is accepted as a full one afterwards.
template <class Advance>
StepLimit max_obstacle_step(double dhat, double smallest_gap, const Advance& advance) {
  constexpr double full_step_min_gap_factor = 0.9;
  constexpr int full_step_max_iterations = 4096, partial_step_max_iterations = 256;
  const double min_gap = 0.8 * std::min(0.125 * dhat, smallest_gap);
  const StepLimit full = advance(full_step_min_gap_factor * min_gap, full_step_max_iterations);
  if (full.fraction == 1) return {};
  const StepLimit partial = advance(min_gap, partial_step_max_iterations);
  return partial.fraction < full.fraction ? partial : full;
}

}  // namespace drape
