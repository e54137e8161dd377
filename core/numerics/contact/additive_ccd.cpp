#include "core/numerics/contact/additive_ccd.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/contact/moving_pairs.h"

namespace drape {
namespace {

using Eigen::Vector3d;

constexpr int pairs_per_task = 1024;
constexpr int max_iterations = 256;
constexpr double tolerance = 0.02;  // fraction of the initial gap that may remain unused

/// A pair and its linear motion, relative to vertex 0 and without the mean displacement: both leave distances
/// unchanged and reduce round-off.
struct Motion {
  PairKind kind;
  double offset;       // of the pair [m]
  double rounding;     // bound on the round-off of a distance, with a wide margin [m]
  PairPositions x, p;  // initial positions and displacements [m]

  Motion(const ContactPair& pair, const Positions& x0, const Positions& x1, const Positions& obstacles)
      : kind(pair.kind), offset(pair.offset), x(positions_of(pair, x0, obstacles)) {
    const double size = x.cwiseAbs().maxCoeff();
    p = positions_of(pair, x1, obstacles) - x;
    rounding = 16 * std::numeric_limits<double>::epsilon() * (size + p.cwiseAbs().maxCoeff() + offset);
    x.colwise() -= Vector3d(x.col(0));
    p.colwise() -= Vector3d(p.rowwise().mean());
  }

  /// Vertices [0, first_end) against [first_end, 4).
  int first_end() const { return first_primitive_size(kind); }

  /// Whether the bounding boxes alone guarantee `min_gap_fraction` of the gap.
  bool stays_apart(double min_gap_fraction) const {
    const double distance = box_distance(kind, x);
    return (distance - offset - rounding) * (1 - min_gap_fraction) > speed();
  }

  /// An upper bound of the rate at which the distance shrinks [m per whole motion].
  double speed() const {
    double a = 0, b = 0;
    for (int k = 0; k < 4; ++k) {
      double& largest = k < first_end() ? a : b;
      largest = std::max(largest, p.col(k).squaredNorm());
    }
    return std::sqrt(a) + std::sqrt(b);
  }

  /// The time for which the two primitives stay at least `distance` apart along n.
  double separation_time(const PairPositions& now, const Vector3d& n, double distance) const {
    double time = std::numeric_limits<double>::infinity();
    for (int a = 0; a < first_end(); ++a)
      for (int b = first_end(); b < 4; ++b) {
        const double room = n.dot(now.col(a) - now.col(b)) - distance, rate = n.dot(p.col(b) - p.col(a));
        if (room < 0) return 0;
        if (rate > 0) time = std::min(time, room / rate);
      }
    return time;
  }
};

/// The part of the motion that keeps `min_gap_fraction` of the gap, at most `limit`.
double safe_time(const Motion& motion, double min_gap_fraction, double limit) {
  const double speed = motion.speed();
  if (speed == 0 || motion.stays_apart(min_gap_fraction)) return limit;
  double time = 0, initial_gap = 0;
  // If nearly the whole gap is to be kept, the usual tolerance exceeds the part that may be used.
  const double allowance = std::min(tolerance, 0.5 * (1 - min_gap_fraction));
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const PairPositions now = motion.x + time * motion.p;
    const Closest nearest = closest(motion.kind, now);
    const double distance = connection(now, nearest).norm(), gap = distance - motion.offset - motion.rounding;
    if (iteration == 0) initial_gap = gap;
    const double room = gap - min_gap_fraction * initial_gap;
    if (!(room > allowance * initial_gap)) return time;
    time += std::max(room / speed,
                     motion.separation_time(now, separating_direction(now, nearest), distance - room));
    if (time >= limit) return limit;
  }
  return time;
}

/// Marks the pairs whose distance and speed alone guarantee `min_gap_fraction` of the gap for the whole
/// motion, as safe_time would find in its first iteration. `rounding` is at least that of each Motion.
void mark_safe(const ContactPair* pairs, int count, const LinearMotion& motion, double min_gap_fraction,
               double rounding, char* safe) {
  for_each_pack(pairs, count, motion, [&](const auto& moving, const int* indices, int size) {
    const auto stays = (moving.separation - rounding) * (1 - min_gap_fraction) > moving.speed * (1 + 1e-9);
    for (int lane = 0; lane < size; ++lane) safe[indices[lane]] = stays[lane];
  });
}

double largest_coordinate(const Positions& x) { return x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0; }

}  // namespace

SafeFraction additive_ccd(const Positions& x0, const Positions& x1, const Positions& obstacle_vertices,
                          const std::vector<ContactPair>& pairs, double min_gap_fraction) {
  if (pairs.empty()) return {};
  const int size = static_cast<int>(pairs.size());
  const double farthest =
      std::max({largest_coordinate(x0), largest_coordinate(x1), largest_coordinate(obstacle_vertices)});
  const double rounding = 16 * std::numeric_limits<double>::epsilon() * 3 * farthest;
  const LinearMotion motion{x0, x1, 0, obstacle_vertices, obstacle_vertices};
  std::vector<SafeFraction> pieces((size + pairs_per_task - 1) / pairs_per_task);
  parallel_for(size, pairs_per_task, [&](int begin, int end) {
    SafeFraction& first = pieces[begin / pairs_per_task];
    char safe[pairs_per_task] = {};
    mark_safe(&pairs[begin], end - begin, motion, min_gap_fraction, rounding, safe);
    for (int i = begin; i < end; ++i) {
      if (safe[i - begin]) continue;
      const double time =
          safe_time(Motion(pairs[i], x0, x1, obstacle_vertices), min_gap_fraction, first.fraction);
      if (time < first.fraction) first = {time, i};
    }
  });
  SafeFraction first;
  for (const SafeFraction& piece : pieces)
    if (piece.fraction < first.fraction) first = piece;
  return first;
}

}  // namespace drape
