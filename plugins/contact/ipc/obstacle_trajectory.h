#pragma once

#include <string>
#include <vector>

#include "core/numerics/collision_detection/broad_phase.h"
#include "core/numerics/contact/candidates.h"
#include "plugins/contact/ipc/obstacle.h"

namespace drape::ipc {

/// A segment of the obstacles' trajectory: local coordinates and transform parameters change linearly with
/// the time t in [0, 1].
struct TrajectorySegment {
  struct Body {
    bool moves = false;
    Pose begin, end;
    Eigen::Matrix3d rotation;  ///< at t = 0
  };
  std::vector<Body> bodies;
  Positions local_begin, local_end;  ///< of all bodies [m]
  Positions begin, end;              ///< in world coordinates [m]
  double chord_error = 0;            ///< bound of a vertex's distance to the chord from begin to end [m]

  Eigen::Matrix3d linear(int body, double time) const;
  Eigen::Vector3d translate(int body, double time) const;
  /// Bounds the acceleration |p''| of a vertex, by t [m].
  double acceleration_bound(int body, int vertex) const;
};

/// The motion of obstacles between two states: their parameters change linearly over the time [0, 1].
class ObstacleTrajectory {
 public:
  /// Keeps references to both. Throws std::runtime_error naming an obstacle whose triangles changed.
  ObstacleTrajectory(const Obstacles& before, const Obstacles& after);

  bool is_static() const;
  /// The end, at most `end`, of the longest segment from `begin` within one pair of animation frames and
  /// within a rotation of 0.1 rad.
  double segment_end(double begin, double end) const;
  TrajectorySegment segment(double begin, double end) const;

  /// The largest collision-free step with the cloth at x, which leaves the minimum gap of
  /// core/numerics/collision_detection/nonlinear_ccd.h. The limit names the blocking pair.
  StepLimit max_step(const Surface& cloth, const Positions& x, double dhat, BroadPhaseKind broad_phase) const;

 private:
  struct Search;
  bool find(const TrajectorySegment& segment, Search& search, long limit) const;
  double smallest_gap(Search& search) const;
  StepLimit advance(Search& search, double min_gap, int max_iterations) const;

  const Obstacles &before_, &after_;
  std::vector<char> moves_;
};

/// "cloth vertex 3 and ball triangle 4–5–6".
std::string name_of(const ContactPair& pair, const Obstacles& obstacles, int cloth_vertices);

}  // namespace drape::ipc
