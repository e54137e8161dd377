#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/numerics/collision_detection/nonlinear_ccd.h"
#include "core/numerics/contact/pair_geometry.h"
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

/// A segment of the obstacles' trajectory: local coordinates and transform parameters change linearly with
/// the time t in [0, 1].
struct TrajectorySegment {
  /// Of one that moves.
  struct Body {
    Pose begin, end;
    Eigen::Matrix3d rotation;  ///< at t = 0
  };
  std::vector<Body> bodies;
  Positions local_begin, local_end;  ///< of all bodies [m]
  Positions begin, end;              ///< in world coordinates [m]
  double chord_error = 0;            ///< bound of a vertex's distance to the chord from begin to end [m]

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
                 size = std::max(local_begin.row(vertex).norm(), local_end.row(vertex).norm()),
                 growth = (local_end.row(vertex) - local_begin.row(vertex)).norm();
    return omega * omega * scale * size +
           2 * (scaling * omega * size + scale * omega * growth + scaling * growth);
  }
};

/// A pair of the cloth at rest and an obstacle on a segment of its trajectory.
class PairOnSegment {
 public:
  PairOnSegment(const ContactPair& pair, const Positions& x, const TrajectorySegment& segment,
                const Obstacles& obstacles)
      : pair_(pair), segment_(segment), cloth_count_(static_cast<int>(x.rows())) {
    for (int k = 0; k < 4; ++k) {
      const int v = pair.vertices[k] - cloth_count_;
      if (v < 0) {
        start_.col(k) = x.row(pair.vertices[k]);
      } else {
        body_ = obstacles.body_of(v);
        start_.col(k) = segment.begin.row(v);
        acceleration_bound_ = std::max(acceleration_bound_, segment.acceleration_bound(body_, v));
        chord_ = std::max(chord_, (segment.end.row(v) - segment.begin.row(v)).norm());
      }
    }
    rounding_ = 32 * std::numeric_limits<double>::epsilon() *
                (start_.cwiseAbs().maxCoeff() + chord_ + acceleration_bound_);
  }

  /// The part of the segment that keeps a gap of at least `min_gap`.
  double advance(double min_gap, int max_iterations) const {
    if (box_distance(pair_.kind, start_) - rounding_ >= min_gap + chord_ + acceleration_bound_ / 8) return 1;
    const auto widest = [&](double t) {
      const PairPositions now = at(t);
      const Eigen::Vector3d n = separating_direction(now, closest(pair_.kind, now));
      return SeparatingPlane{n, separation(now, n)};
    };
    return nonlinear_ccd(
        widest, [&](const Eigen::Vector3d& n, double t) { return separation(at(t), n); }, min_gap,
        acceleration_bound_, max_iterations);
  }

 private:
  PairPositions at(double t) const {
    PairPositions now = start_;
    if (t == 0) return now;
    if (t == 1) {
      for (int k = 0; k < 4; ++k)
        if (const int v = pair_.vertices[k] - cloth_count_; v >= 0) now.col(k) = segment_.end.row(v);
      return now;
    }
    const Eigen::Matrix3d linear = segment_.linear(body_, t);
    const Eigen::Vector3d translate = segment_.translate(body_, t);
    for (int k = 0; k < 4; ++k)
      if (const int v = pair_.vertices[k] - cloth_count_; v >= 0)
        now.col(k) =
            linear * interpolate<Eigen::Vector3d>(segment_.local_begin.row(v), segment_.local_end.row(v), t) +
            translate;
    return now;
  }

  /// The separation along n, which points from the second primitive to the first.
  double separation(const PairPositions& now, const Eigen::Vector3d& n) const {
    double smallest = std::numeric_limits<double>::infinity();
    for (int a = 0; a < first_primitive_size(pair_.kind); ++a)
      for (int b = first_primitive_size(pair_.kind); b < 4; ++b)
        smallest = std::min(smallest, n.dot(now.col(a) - now.col(b)));
    return smallest - rounding_;
  }

  const ContactPair& pair_;
  const TrajectorySegment& segment_;
  int cloth_count_;
  int body_ = 0;                   // the obstacle's
  PairPositions start_;            // at t = 0 [m]
  double acceleration_bound_ = 0;  // of the obstacle's vertices [m]
  double chord_ = 0;               // the longest of their chords [m]
  double rounding_;                // bound on the round-off of a distance, with a wide margin [m]
};

}  // namespace drape::ipc
