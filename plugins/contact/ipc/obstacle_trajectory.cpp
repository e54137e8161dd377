#include "plugins/contact/ipc/obstacle_trajectory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/collision_detection/nonlinear_ccd.h"
#include "core/numerics/contact/candidates.h"
#include "core/numerics/linear_algebra/interpolate.h"
#include "core/numerics/mesh/rotation.h"
#include "core/numerics/mesh/same_entries.h"
#include "plugins/contact/ipc/cloth_search.h"
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
      if (moves[obstacles.body_of(obstacles.topology->triangles(rows.items[i], 0))])
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
    if (&from.triangles() != &to.triangles() && !same_entries(from.triangles(), to.triangles()))
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
  /// Keeps references to before, search and x.
  ObstacleTrajectory(const ObstacleTree& before, std::shared_ptr<const Obstacles> after,
                     std::vector<char> moves, ClothSearch& search, const Positions& x, double dhat)
      : tree_before_(before),
        before_(before.obstacles),
        after_(std::move(after)),
        moves_(std::move(moves)),
        x_(x),
        dhat_(dhat),
        search_(search),
        boxes_(*after_->topology),
        tree_(before.tree->copy()) {}

  /// The smallest gap at the start, at most d̂ [m].
  double smallest_gap() {
    double gap = dhat_;
    for_each_segment([&](const TrajectorySegment& first) {
      for (const ObstaclePair& pair : search_.pairs) {
        const PairPositions at = positions_of(pair, x_, *first.begin.world);
        if (box_distance(pair.kind, at) > (1 + 1e-12) * gap) continue;  // the factor covers round-off
        gap = std::min(gap, connection(at, closest(pair.kind, at)).norm());
      }
      return false;
    });
    return gap;
  }

  /// The largest step that leaves min_gap [m].
  StepLimit advance(double min_gap, int max_iterations) {
    StepLimit limit;
    for_each_segment([&](const TrajectorySegment& segment) {
      const std::vector<ObstaclePair>& pairs = search_.pairs;
      std::vector<double> fractions(pairs.size());
      parallel_for(static_cast<int>(fractions.size()), 64, [&](int begin, int stop) {
        for (int i = begin; i < stop; ++i)
          fractions[i] = advance_pair(pairs[i], x_, segment, *after_, min_gap, max_iterations);
      });
      const auto smallest = std::min_element(fractions.begin(), fractions.end());
      if (smallest == fractions.end() || *smallest == 1) return true;
      const ObstaclePair& pair = pairs[smallest - fractions.begin()];
      limit = {interpolate<double>(segment.begin.time, segment.end.time, *smallest),
               name_of(pair.vertices, pair.kind, *after_, static_cast<int>(x_.rows()))};
      return false;
    });
    return limit;
  }

 private:
  /// Calls visit(segment) for segments in turn, with search_.pairs those that may come within d̂ on it, until
  /// it returns false.
  template <class Visit>
  void for_each_segment(const Visit& visit) {
    long limit = initial_pair_limit;
    for (double time = 0, length = 1; time < 1;) {
      const double end = segment_end(time, std::min(1.0, time + length));
      if (!search(time, end, limit)) {
        length = (end - time) / 4;
        limit *= 2;
        continue;
      }
      if (!visit(*segment_)) return;
      length = 2 * (end - time);
      time = end;
    }
  }

  /// The end, at most `end`, of the longest segment from `begin` within one pair of animation frames and
  /// within a rotation of 0.1 rad.
  double segment_end(double begin, double end) const {
    for (std::size_t i = 0; i < moves_.size(); ++i) {
      if (!moves_[i]) continue;
      const ObstacleGeometry &from = before_->bodies[i].geometry, &to = after_->bodies[i].geometry;
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

  /// The obstacles' vertices at a time.
  PlacedVertices placed_at(double time) const {
    if (time == 0) return {time, {before_, &before_->local}, {before_, &before_->vertices}};
    if (time == 1) return {time, {after_, &after_->local}, {after_, &after_->vertices}};
    auto local = std::make_shared<Positions>(before_->local),
         world = std::make_shared<Positions>(before_->vertices);
    for (std::size_t i = 0; i < moves_.size(); ++i) {
      if (!moves_[i]) continue;
      const ObstacleGeometry &from = before_->bodies[i].geometry, &to = after_->bodies[i].geometry;
      const Positions own =
          are_equal(from.frames, to.frames) && from.local_scale == to.local_scale
              ? from.local_positions(interpolate<double>(from.frame, to.frame, time))
              : interpolate<Positions>(from.local_positions(from.frame), to.local_positions(to.frame), time);
      local->middleRows(before_->first_vertex[i], own.rows()) = own;
      world->middleRows(before_->first_vertex[i], own.rows()) =
          pose_between(from.pose, to.pose, time).applied_to(own);
    }
    return {time, std::move(local), std::move(world)};
  }

  TrajectorySegment segment(double begin, double end) const {
    TrajectorySegment segment{{}, placed_at(begin), placed_at(end)};
    for (std::size_t i = 0; i < moves_.size(); ++i) {
      TrajectorySegment::Body& body = segment.bodies.emplace_back();
      if (!moves_[i]) continue;
      const Pose &from = before_->bodies[i].geometry.pose, &to = after_->bodies[i].geometry.pose;
      body.begin = pose_between(from, to, begin);
      body.end = pose_between(from, to, end);
      body.rotation = rotation_matrix(body.begin.rotate);
      if (body.is_straight()) continue;
      for (int v = before_->first_vertex[i]; v < before_->first_vertex[i + 1]; ++v)
        segment.chord_error =
            std::max(segment.chord_error, segment.acceleration_bound(static_cast<int>(i), v) / 8);
    }
    return segment;
  }

  /// Sets segment_ and search_.pairs to those that may come within d̂ on it, unless they are that already.
  /// Returns false if there are more than `limit`.
  bool search(double begin, double end, long limit) {
    if (segment_ && segment_->begin.time == begin && segment_->end.time == end) return true;
    TrajectorySegment next = segment(begin, end);
    segment_.reset();
    boxes_.update(*next.begin.world, *next.end.world, 0.5 * dhat_ + next.chord_error, tree_before_.origin);
    const LinearMotion motion{x_, x_, dhat_ + next.chord_error, *next.begin.world, *next.end.world};
    if (search_.find_in_skin(motion, boxes_, tree_before_, dhat_, limit)) {
      const auto n = static_cast<int>(x_.rows());
      std::erase_if(search_.pairs, [&](const ObstaclePair& pair) {
        return !moves_[after_->body_of(*std::ranges::max_element(pair.vertices) - n)];
      });
      if (std::ssize(search_.pairs) > limit) return false;
    } else {
      search_.update(x_, x_, 0.5 * dhat_, tree_before_.origin);
      tree_->update(boxes_.triangles);
      if (!search_.tree->overlaps(*tree_, limit, search_.rows)) return false;
      remove_static(search_.rows, moves_, *after_);
      if (!find_obstacle_pairs(search_.boxes, boxes_, search_.rows, motion, limit, search_.pairs))
        return false;
    }
    segment_ = std::move(next);
    return true;
  }

  const ObstacleTree& tree_before_;
  std::shared_ptr<const Obstacles> before_, after_;
  std::vector<char> moves_;
  const Positions& x_;
  double dhat_;
  ClothSearch& search_;
  SweptBoxes boxes_;
  std::unique_ptr<BroadPhase> tree_;
  std::optional<TrajectorySegment> segment_;  // that search_.pairs are of
};

}  // namespace

StepLimit max_trajectory_step(const ObstacleTree& before, const std::shared_ptr<const Obstacles>& after,
                              ClothSearch& search, const Positions& x, double dhat) {
  std::vector<char> moves = moving_bodies(*before.obstacles, *after);
  if (std::ranges::count(moves, 1) == 0) return {};
  ObstacleTrajectory trajectory(before, after, std::move(moves), search, x, dhat);
  return max_obstacle_step(dhat, trajectory.smallest_gap(), [&](double min_gap, int max_iterations) {
    return trajectory.advance(min_gap, max_iterations);
  });
}

std::string name_of(const std::array<int, 4>& v, PairKind kind, const Obstacles& obstacles,
                    int cloth_vertices) {
  const auto name = [&](const std::string& primitive, const std::vector<int>& vertices) {
    const int body = obstacles.body_of(vertices[0] - cloth_vertices);
    const bool of_cloth = vertices[0] < cloth_vertices;
    const int first = of_cloth ? 0 : cloth_vertices + obstacles.first_vertex[body];
    std::string text = (of_cloth ? "cloth" : obstacles.bodies[body].name) + " " + primitive;
    for (std::size_t k = 0; k < vertices.size(); ++k)
      text += (k == 0 ? " " : "–") + std::to_string(vertices[k] - first);
    return text;
  };
  if (kind == PairKind::edge_edge) return name("edge", {v[0], v[1]}) + " and " + name("edge", {v[2], v[3]});
  return name("vertex", {v[0]}) + " and " + name("triangle", {v[1], v[2], v[3]});
}

}  // namespace drape::ipc
