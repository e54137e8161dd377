#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace drape {

/// An empty slab between two convex things: its normal, and its width along it [m].
struct Slab {
  Eigen::Vector3d normal;
  double width;
};

/// The part of a motion over [0, 1] on which one convex thing, at rest, stays at least `kept` [m] away from
/// another whose points all move on curves p(t) with |p''| ≤ bend [m]. `widest(t)` is a slab between them at
/// t, as wide as can be; `width(n, t)` that of another normal, negative where it does not separate them.
///
/// Conservative advancement: between t and t + s a point is within bend s²/8 of its chord, so a slab that is
/// wider than kept + bend s²/8 at both ends stays empty. Any slab is safe, however inaccurate; the answer is
/// short of what would be allowed only where `rounds` of them are not enough.
template <class Widest, class Width>
double bent_advance(const Widest& widest, const Width& width, double kept, double bend, int rounds) {
  constexpr double slack = 0.02, shortest = 1e-12;
  double t = 0, reach = 1;
  for (int round = 0; round < rounds; ++round) {
    const Slab slab = widest(t);
    if (!(slab.width > (1 + slack) * kept)) return t;
    double step = std::min(reach, 1 - t);
    while (!(std::min(slab.width, width(slab.normal, t + step)) - bend * step * step / 8 >= kept)) {
      step *= 0.5;
      if (step < shortest) return t;
    }
    t += step;
    if (t >= 1) return 1;
    reach = 4 * step;
  }
  return t;
}

/// What obstacles that move leave of a cloth's gaps to them, of which `smallest` is the smallest [m]: a tenth
/// of the range, but not much less than there is. Were it a small part of that, an obstacle that presses on
/// would take up whatever the cloth gains, and gaps would shrink to nothing.
inline double gap_left_by_moves(double range, double smallest) {
  return 0.8 * std::min(0.125 * range, smallest);
}

/// A way is looked at twice: allowed as a whole where it leaves this part of that, else shortened to where
/// all of it is left. So what was shortened is not shortened again.
inline constexpr double left_by_whole = 0.9;
inline constexpr int rounds_of_whole = 4096, rounds_of_part = 256;

}  // namespace drape
