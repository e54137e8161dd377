#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contact/pair_contacts.h"
#include "core/contact/pair_geometry.h"
#include "core/numerics/parallel.h"

namespace drape {
namespace {

using Eigen::Vector3d;

constexpr int grain = 1024, max_rounds = 256;
constexpr double slack = 0.02;  // part of the first gap that need not be used up

/// A pair and its motion, in coordinates that keep few digits busy: relative to vertex 0, and less the mean
/// displacement, which changes no distance.
struct Motion {
  PairKind kind;
  double offset, rounding;
  PairPositions x, p;

  Motion(const ContactPair& pair, const Positions& x0, const Positions& x1, const Positions& obstacles)
      : kind(pair.kind), offset(pair.offset), x(positions_of(pair, x0, obstacles)) {
    const double size = x.cwiseAbs().maxCoeff();
    p = positions_of(pair, x1, obstacles) - x;
    rounding = 16 * std::numeric_limits<double>::epsilon() * (size + p.cwiseAbs().maxCoeff() + offset);
    x.colwise() -= Vector3d(x.col(0));
    if (kind != PairKind::point_plane) p.colwise() -= Vector3d(p.rowwise().mean());
  }

  /// Vertices [0, first_end) against [first_end, end); a plane is known by one of its points.
  int first_end() const { return first_side(kind); }
  int end() const { return kind == PairKind::point_plane ? 2 : 4; }

  /// Whether it cannot come nearer than `keep` of the gap, from its boxes alone.
  bool stays_away(double keep) const {
    const double apart = box_distance(kind, x);
    return (apart - offset - rounding) * (1 - keep) > speed();
  }

  /// Bounds how fast the distance changes.
  double speed() const {
    double a = 0, b = 0;
    for (int k = 0; k < end(); ++k) {
      double& largest = k < first_end() ? a : b;
      largest = std::max(largest, p.col(k).squaredNorm());
    }
    return std::sqrt(a) + std::sqrt(b);
  }

  /// For how long the two sides are sure to stay `distance` apart along the direction n.
  double separated(const PairPositions& now, const Vector3d& n, double distance) const {
    double time = std::numeric_limits<double>::infinity();
    for (int a = 0; a < first_end(); ++a)
      for (int b = first_end(); b < end(); ++b) {
        const double room = n.dot(now.col(a) - now.col(b)) - distance, rate = n.dot(p.col(b) - p.col(a));
        if (room < 0) return 0;
        if (rate > 0) time = std::min(time, room / rate);
      }
    return time;
  }
};

/// Part of the motion after which `keep` of the gap is left, or `limit` if that is less.
double safe_time(const Motion& motion, double keep, double limit) {
  const double speed = motion.speed();
  if (speed == 0 || motion.stays_away(keep)) return limit;
  double time = 0, first_gap = 0;
  for (int round = 0; round < max_rounds; ++round) {
    const PairPositions now = motion.x + time * motion.p;
    const Closest nearest = closest(motion.kind, now);
    const double distance = connection(now, nearest).norm(), gap = distance - motion.offset - motion.rounding;
    if (round == 0) first_gap = gap;
    const double room = gap - keep * first_gap;
    if (!(room > slack * first_gap)) return time;
    time +=
        std::max(room / speed, motion.separated(now, separating_direction(now, nearest), distance - room));
    if (time >= limit) return limit;
  }
  return time;
}

}  // namespace

double additive_ccd(const Positions& x0, const Positions& x1, const Positions& obstacle_vertices,
                    const std::vector<ContactPair>& pairs, double keep, int& blocking) {
  struct First {
    double time = 1;
    int pair = -1;
  };
  const int size = static_cast<int>(pairs.size());
  std::vector<First> pieces((size + grain - 1) / grain);
  parallel_for(size, grain, [&](int begin, int end) {
    First& first = pieces[begin / grain];
    for (int i = begin; i < end; ++i) {
      const double time = safe_time(Motion(pairs[i], x0, x1, obstacle_vertices), keep, first.time);
      if (time < first.time) first = {time, i};
    }
  });
  First first;
  for (const First& piece : pieces)
    if (piece.time < first.time) first = piece;
  blocking = first.pair;
  return first.time;
}

}  // namespace drape
