#include "plugins/contact/ipc/obstacle_trajectory.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/collision_detection/nonlinear_ccd.h"
#include "core/numerics/contact/candidates.h"
#include "core/numerics/linear_algebra/interpolate.h"
#include "core/numerics/mesh/rotation.h"
#include "core/numerics/mesh/same_entries.h"
#include "plugins/contact/ipc/trajectory_segment.h"

namespace drape::ipc {
namespace {

using Eigen::Vector3d;

constexpr double max_rotation = 0.1;  // of a segment, which bounds the chord error that inflates boxes [rad]
constexpr long initial_pair_limit = 100'000;  // per segment; above it a shorter segment is tried

/// Removes triangles of static bodies from the rows.
void remove_static(AdjacencyList& rows, const std::vector<char>& moves, const Obstacles& obstacles) {
  int count = 0;
  for (std::size_t row = 0; row + 1 < rows.start.size(); ++row) {
    const int begin = rows.start[row];
    rows.start[row] = count;
    for (int i = begin; i < rows.start[row + 1]; ++i)
      if (moves[obstacles.body_of(obstacles.surface.triangles(rows.items[i], 0))])
        rows.items[count++] = rows.items[i];
  }
  rows.start.back() = count;
  rows.items.resize(count);
}

/// Whether each body moves between two states of the obstacles, which have equally many. Throws
/// std::runtime_error naming one whose triangles changed.
std::vector<char> moving_bodies(const Obstacles& before, const Obstacles& after) {
  std::vector<char> moves;
  for (std::size_t i = 0; i < after.bodies.size(); ++i) {
    const Obstacle &from = before.bodies[i], &to = after.bodies[i];
    if (!same_entries(from.triangles(), to.triangles()))
      throw std::runtime_error("obstacle \"" + to.name + "\": its mesh changed: it has " +
                               std::to_string(to.triangles().rows()) + " triangles instead of " +
                               std::to_string(from.triangles().rows()) +
                               "; during a run it may only move, rotate, scale and change its frame");
    moves.push_back(!(from.geometry == to.geometry));
  }
  return moves;
}

/// The motion of obstacles between two states, over the time [0, 1], beside a cloth at rest at x.
class ObstacleTrajectory {
 public:
  /// Keeps references to before, after, cloth and x.
  ObstacleTrajectory(const Obstacles& before, const Obstacles& after, std::vector<char> moves,
                     const Surface& cloth, const Positions& x, double dhat, BroadPhaseKind kind)
      : before_(before),
        after_(after),
        moves_(std::move(moves)),
        x_(x),
        dhat_(dhat),
        cloth_tree_(make_broad_phase(kind)),
        tree_(make_broad_phase(kind)),
        cloth_boxes_(cloth),
        boxes_(after.surface) {
    cloth_boxes_.update(x, x, 0.5 * dhat, x.row(0));
    cloth_tree_->update(cloth_boxes_.triangles);
  }

  /// The smallest gap at the start, at most d̂ [m].
  double smallest_gap() {
    find(segment(0, 0), std::numeric_limits<long>::max());
    double gap = dhat_;
    for (const ContactPair& pair : found_) {
      const PairPositions at = positions_of(pair, x_, before_.vertices);
      gap = std::min(gap, connection(at, closest(pair.kind, at)).norm());
    }
    return gap;
  }

  /// The largest step that leaves min_gap [m].
  StepLimit advance(double min_gap, int max_iterations) {
    long limit = initial_pair_limit;
    for (double time = 0, length = 1; time < 1;) {
      const double end = segment_end(time, std::min(1.0, time + length));
      const TrajectorySegment segment = this->segment(time, end);
      if (!find(segment, limit)) {
        length = (end - time) / 4;
        limit *= 2;
        continue;
      }
      std::vector<double> fractions(found_.size());
      parallel_for(static_cast<int>(fractions.size()), 64, [&](int begin, int stop) {
        for (int i = begin; i < stop; ++i)
          fractions[i] = advance_pair(found_[i], x_, segment, after_, min_gap, max_iterations);
      });
      const auto smallest = std::min_element(fractions.begin(), fractions.end());
      if (smallest != fractions.end() && *smallest < 1)
        return {interpolate<double>(time, end, *smallest),
                name_of(found_[smallest - fractions.begin()], after_, static_cast<int>(x_.rows()))};
      length = 2 * (end - time);
      time = end;
    }
    return {};
  }

 private:
  /// The end, at most `end`, of the longest segment from `begin` within one pair of animation frames and
  /// within a rotation of 0.1 rad.
  double segment_end(double begin, double end) const {
    for (std::size_t i = 0; i < moves_.size(); ++i) {
      if (!moves_[i]) continue;
      const ObstacleGeometry &from = before_.bodies[i].geometry, &to = after_.bodies[i].geometry;
      if (const double angle = rotation_angle(from.pose, to.pose); angle > 0)
        end = std::min(end, begin + max_rotation / angle);
      if (!are_equal(from.frames, to.frames) || from.frame == to.frame) continue;
      const double rate = to.frame - from.frame, now = from.frame + begin * rate;
      // A frame exceeded by less than round-off counts as reached.
      const double next = rate > 0 ? std::floor(now + 1e-12) + 1 : std::ceil(now - 1e-12) - 1;
      end = std::min(end, std::max((next - from.frame) / rate, begin + 1e-12));
    }
    return end;
  }

  TrajectorySegment segment(double begin, double end) const {
    TrajectorySegment segment;
    segment.local_begin.resize(before_.vertices.rows(), 3);
    segment.local_end.resize(before_.vertices.rows(), 3);
    segment.begin = segment.end = before_.vertices;
    for (std::size_t i = 0; i < moves_.size(); ++i) {
      TrajectorySegment::Body& body = segment.bodies.emplace_back();
      if (!moves_[i]) continue;
      const ObstacleGeometry &from = before_.bodies[i].geometry, &to = after_.bodies[i].geometry;
      body.begin = pose_between(from.pose, to.pose, begin);
      body.end = pose_between(from.pose, to.pose, end);
      body.rotation = rotation_matrix(body.begin.rotate);
      const auto local_at = [&](double t) {
        if (are_equal(from.frames, to.frames) && from.local_scale == to.local_scale)
          return from.local_positions(interpolate<double>(from.frame, to.frame, t));
        return interpolate<Positions>(from.local_positions(from.frame), to.local_positions(to.frame), t);
      };
      const int first = before_.first_vertex[i], count = before_.first_vertex[i + 1] - first;
      const Positions local_begin = local_at(begin), local_end = local_at(end);
      segment.local_begin.middleRows(first, count) = local_begin;
      segment.local_end.middleRows(first, count) = local_end;
      segment.begin.middleRows(first, count) = body.begin.applied_to(local_begin);
      segment.end.middleRows(first, count) = body.end.applied_to(local_end);
      for (int v = first; v < first + count; ++v)
        segment.chord_error =
            std::max(segment.chord_error, segment.acceleration_bound(static_cast<int>(i), v) / 8);
    }
    return segment;
  }

  /// Finds the pairs that may come within d̂ on a segment. Returns false if there are more than `limit`.
  bool find(const TrajectorySegment& segment, long limit) {
    boxes_.update(segment.begin, segment.end, 0.5 * dhat_ + segment.chord_error, x_.row(0));
    tree_->update(boxes_.triangles);
    found_.clear();
    if (!cloth_tree_->overlaps(*tree_, limit, rows_)) return false;
    remove_static(rows_, moves_, after_);
    return find_obstacle_pairs(cloth_boxes_, after_, boxes_, rows_,
                               {x_, x_, dhat_ + segment.chord_error, segment.begin, segment.end}, 0, limit,
                               found_);
  }

  const Obstacles &before_, &after_;
  std::vector<char> moves_;
  const Positions& x_;
  double dhat_;
  std::unique_ptr<BroadPhase> cloth_tree_, tree_;
  SweptBoxes cloth_boxes_, boxes_;
  AdjacencyList rows_;
  std::vector<ContactPair> found_;  // on the last segment
};

}  // namespace

StepLimit max_trajectory_step(const Obstacles& before, const Obstacles& after, const Surface& cloth,
                              const Positions& x, double dhat, BroadPhaseKind broad_phase) {
  std::vector<char> moves = moving_bodies(before, after);
  if (std::ranges::count(moves, 1) == 0) return {};
  ObstacleTrajectory trajectory(before, after, std::move(moves), cloth, x, dhat, broad_phase);
  return max_obstacle_step(dhat, trajectory.smallest_gap(), [&](double min_gap, int max_iterations) {
    return trajectory.advance(min_gap, max_iterations);
  });
}

std::string name_of(const ContactPair& pair, const Obstacles& obstacles, int cloth_vertices) {
  const auto& v = pair.vertices;
  const auto name = [&](const std::string& primitive, const std::vector<int>& vertices) {
    const int body = obstacles.body_of(vertices[0] - cloth_vertices);
    const bool of_cloth = vertices[0] < cloth_vertices;
    const int first = of_cloth ? 0 : cloth_vertices + obstacles.first_vertex[body];
    std::string text = (of_cloth ? "cloth" : obstacles.bodies[body].name) + " " + primitive;
    for (std::size_t k = 0; k < vertices.size(); ++k)
      text += (k == 0 ? " " : "–") + std::to_string(vertices[k] - first);
    return text;
  };
  if (pair.kind == PairKind::edge_edge)
    return name("edge", {v[0], v[1]}) + " and " + name("edge", {v[2], v[3]});
  return name("vertex", {v[0]}) + " and " + name("triangle", {v[1], v[2], v[3]});
}

}  // namespace drape::ipc
