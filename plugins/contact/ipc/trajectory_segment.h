#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "core/numerics/collision_detection/nonlinear_ccd.h"
#include "core/numerics/contact/candidates.h"
#include "core/numerics/linear_algebra/interpolate.h"
#include "plugins/contact/ipc/obstacle.h"

namespace drape::ipc {

inline Pose pose_between(const Pose& a, const Pose& b, double t) {
  return {interpolate<double>(a.scale, b.scale, t), interpolate<Eigen::Vector3d>(a.rotate, b.rotate, t),
          interpolate<Eigen::Vector3d>(a.translate, b.translate, t)};
}

/// A bound of the rotation from one pose to the other [rad].
inline double rotation_angle(const Pose& a, const Pose& b) {
  return (M_PI / 180) * (b.rotate - a.rotate).cwiseAbs().sum();
}

/// Where the obstacles' vertices are at one time, in local and in world coordinates (n×3) [m].
struct PlacedVertices {
  double time;
  std::shared_ptr<const Positions> local, world;
};

/// A segment of the obstacles' trajectory: local coordinates and transform parameters change linearly with
/// the time t in [0, 1].
struct TrajectorySegment {
  /// The motion of one obstacle.
  struct Body {
    Pose begin, end;
    Eigen::Matrix3d rotation;  ///< at t = 0

    /// Whether every vertex moves along a line, so that its acceleration_bound is 0.
    bool is_straight() const { return rotation_angle(begin, end) == 0 && begin.scale == end.scale; }
  };
  std::vector<Body> bodies;
  PlacedVertices begin, end;
  double chord_error = 0;  ///< bound of a vertex's distance to the chord from begin to end [m]

  Eigen::Matrix3d linear(int body, double time) const {
    const Body& b = bodies[body];
    if (b.begin.rotate == b.end.rotate) return interpolate(b.begin.scale, b.end.scale, time) * b.rotation;
    return pose_between(b.begin, b.end, time).linear();
  }
  Eigen::Vector3d translate(int body, double time) const {
    return interpolate<Eigen::Vector3d>(bodies[body].begin.translate, bodies[body].end.translate, time);
  }
  /// Bounds the acceleration |p''| of a vertex, by t [m]. p = s R b + T with s, b and the angles of R linear:
  /// |R'| ≤ ω, |R''| ≤ ω², ω the sum of the angles' rates.
  double acceleration_bound(int body, int vertex) const {
    const Body& b = bodies[body];
    const double omega = rotation_angle(b.begin, b.end), scale = std::max(b.begin.scale, b.end.scale),
                 scaling = std::abs(b.end.scale - b.begin.scale),
                 size = std::max(begin.local->row(vertex).norm(), end.local->row(vertex).norm()),
                 growth = (end.local->row(vertex) - begin.local->row(vertex)).norm();
    return omega * omega * scale * size +
           2 * (scaling * omega * size + scale * omega * growth + scaling * growth);
  }
};

/// The part of a segment of the obstacles' trajectory on which a pair of the cloth at rest at x and an
/// obstacle keeps a gap of at least `min_gap` [m].
inline double advance_pair(const ObstaclePair& pair, const Positions& x, const TrajectorySegment& segment,
                           const Obstacles& obstacles, double min_gap, int max_iterations) {
  const int n = static_cast<int>(x.rows()), first_end = first_primitive_size(pair.kind);
  const PairPositions start = positions_of(pair, x, *segment.begin.world);
  int body = 0;                                // the obstacle's
  double acceleration_bound = 0, longest = 0;  // of the obstacle's vertices and of their chords [m]
  for (const int vertex : pair.vertices)
    if (const int v = vertex - n; v >= 0) {
      body = obstacles.body_of(v);
      acceleration_bound = std::max(acceleration_bound, segment.acceleration_bound(body, v));
      longest = std::max(longest, (segment.end.world->row(v) - segment.begin.world->row(v)).norm());
    }
  // A bound on the round-off of a distance, with a wide margin [m].
  const double rounding = 32 * std::numeric_limits<double>::epsilon() *
                          (start.cwiseAbs().maxCoeff() + longest + acceleration_bound);
  if (box_distance(pair.kind, start) - rounding >= min_gap + longest + acceleration_bound / 8) return 1;

  const auto at = [&](double t) {
    PairPositions now = start;
    if (t == 0) return now;
    if (t == 1) return positions_of(pair, x, *segment.end.world);
    const Eigen::Matrix3d linear = segment.linear(body, t);
    const Eigen::Vector3d translate = segment.translate(body, t);
    for (int k = 0; k < 4; ++k)
      if (const int v = pair.vertices[k] - n; v >= 0)
        now.col(k) =
            linear * interpolate<Eigen::Vector3d>(segment.begin.local->row(v), segment.end.local->row(v), t) +
            translate;
    return now;
  };
  // Along a normal that points from the second primitive to the first.
  const auto separation = [&](const PairPositions& now, const Eigen::Vector3d& normal) {
    double smallest = std::numeric_limits<double>::infinity();
    for (int a = 0; a < first_end; ++a)
      for (int b = first_end; b < 4; ++b) smallest = std::min(smallest, normal.dot(now.col(a) - now.col(b)));
    return smallest - rounding;
  };
  const auto widest = [&](double t) {
    const PairPositions now = at(t);
    const Eigen::Vector3d normal = separating_direction(now, closest(pair.kind, now));
    return SeparatingPlane{normal, separation(now, normal)};
  };
  return nonlinear_ccd(
      widest, [&](const Eigen::Vector3d& normal, double t) { return separation(at(t), normal); }, min_gap,
      acceleration_bound, max_iterations);
}

}  // namespace drape::ipc
