#include "plugins/contact/ipc/obstacle_trajectory.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/contact/pair_geometry.h"
#include "core/numerics/linear_algebra/interpolate.h"
#include "core/numerics/mesh/rotation.h"
#include "core/numerics/mesh/same_entries.h"
#include "plugins/contact/ipc/pair_on_segment.h"

namespace drape::ipc {
namespace {

using Eigen::Vector3d;

constexpr double degree = M_PI / 180;
constexpr double max_rotation = 0.1;  // of a segment, which bounds the chord error that inflates boxes [rad]
constexpr long initial_pair_limit = 100'000;  // per segment; above it a shorter segment is tried

Pose pose_between(const Pose& a, const Pose& b, double t) {
  return {interpolate<double>(a.scale, b.scale, t), interpolate<Vector3d>(a.rotate, b.rotate, t),
          interpolate<Vector3d>(a.translate, b.translate, t)};
}

/// A bound of the rotation from one pose to the other [rad].
double rotation_angle(const Pose& a, const Pose& b) {
  return degree * (b.rotate - a.rotate).cwiseAbs().sum();
}

Positions transformed(const Positions& local, const Pose& pose) {
  return (local * pose.linear().transpose()).rowwise() + pose.translate.transpose();
}

/// Removes triangles of static bodies from the rows.
void remove_static(AdjacencyList& rows, const TrajectorySegment& segment, const Obstacles& obstacles) {
  int count = 0;
  for (std::size_t row = 0; row + 1 < rows.start.size(); ++row) {
    const int begin = rows.start[row];
    rows.start[row] = count;
    for (int i = begin; i < rows.start[row + 1]; ++i)
      if (segment.bodies[obstacles.body_of(obstacles.surface.triangles(rows.items[i], 0))].moves)
        rows.items[count++] = rows.items[i];
  }
  rows.start.back() = count;
  rows.items.resize(count);
}

}  // namespace

Eigen::Matrix3d TrajectorySegment::linear(int body, double time) const {
  const Body& b = bodies[body];
  if (b.begin.rotate == b.end.rotate) return interpolate(b.begin.scale, b.end.scale, time) * b.rotation;
  return pose_between(b.begin, b.end, time).linear();
}

Vector3d TrajectorySegment::translate(int body, double time) const {
  return interpolate<Vector3d>(bodies[body].begin.translate, bodies[body].end.translate, time);
}

// p = s R b + T with s, b and the angles of R linear: |R'| ≤ ω, |R''| ≤ ω², ω the sum of the angles' rates.
double TrajectorySegment::acceleration_bound(int body, int vertex) const {
  const Body& b = bodies[body];
  const double omega = rotation_angle(b.begin, b.end), scale = std::max(b.begin.scale, b.end.scale),
               scaling = std::abs(b.end.scale - b.begin.scale),
               size = std::max(local_begin.row(vertex).norm(), local_end.row(vertex).norm()),
               growth = (local_end.row(vertex) - local_begin.row(vertex)).norm();
  return omega * omega * scale * size +
         2 * (scaling * omega * size + scale * omega * growth + scaling * growth);
}

ObstacleTrajectory::ObstacleTrajectory(const Obstacles& before, const Obstacles& after)
    : before_(before), after_(after) {
  if (before.bodies.size() != after.bodies.size())
    throw std::runtime_error("obstacles cannot appear or vanish during a run");
  for (std::size_t i = 0; i < after.bodies.size(); ++i) {
    const Obstacle &from = before.bodies[i], &to = after.bodies[i];
    if (!same_entries(from.mesh.triangles, to.mesh.triangles))
      throw std::runtime_error("obstacle \"" + to.name + "\": its mesh changed: it has " +
                               std::to_string(to.mesh.triangles.rows()) + " triangles instead of " +
                               std::to_string(from.mesh.triangles.rows()) +
                               "; during a run it may only move, rotate, scale and change its frame");
    moves_.push_back(!(from.geometry == to.geometry));
  }
}

bool ObstacleTrajectory::is_static() const {
  return std::find(moves_.begin(), moves_.end(), 1) == moves_.end();
}

double ObstacleTrajectory::segment_end(double begin, double end) const {
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

TrajectorySegment ObstacleTrajectory::segment(double begin, double end) const {
  TrajectorySegment segment;
  segment.local_begin.resize(before_.vertices.rows(), 3);
  segment.local_end.resize(before_.vertices.rows(), 3);
  segment.begin = segment.end = before_.vertices;
  for (std::size_t i = 0; i < moves_.size(); ++i) {
    TrajectorySegment::Body& body = segment.bodies.emplace_back();
    body.moves = moves_[i] != 0;
    if (!body.moves) continue;
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
    segment.local_begin.middleRows(first, count) = local_at(begin);
    segment.local_end.middleRows(first, count) = local_at(end);
    segment.begin.middleRows(first, count) =
        transformed(segment.local_begin.middleRows(first, count), body.begin);
    segment.end.middleRows(first, count) = transformed(segment.local_end.middleRows(first, count), body.end);
    for (int v = first; v < first + count; ++v)
      segment.chord_error =
          std::max(segment.chord_error, segment.acceleration_bound(static_cast<int>(i), v) / 8);
  }
  return segment;
}

/// The inputs of a search and its results on the last segment.
struct ObstacleTrajectory::Search {
  Search(const Surface& cloth, const Positions& x, double dhat, BroadPhaseKind kind)
      : cloth(cloth), x(x), dhat(dhat), cloth_tree(make_broad_phase(kind)), tree(make_broad_phase(kind)) {
    cloth_boxes.update(cloth, x, x, 0.5 * dhat);
    cloth_tree->update(cloth_boxes.triangles);
  }

  const Surface& cloth;
  const Positions& x;
  double dhat;
  std::unique_ptr<BroadPhase> cloth_tree, tree;
  SweptBoxes cloth_boxes, boxes;
  AdjacencyList rows;
  BroadPhasePairs found;
};

/// Finds the pairs that may come within d̂ on a segment. Returns false if there are more than `limit`.
bool ObstacleTrajectory::find(const TrajectorySegment& segment, Search& s, long limit) const {
  s.boxes.update(after_.surface, segment.begin, segment.end, 0.5 * s.dhat + segment.chord_error);
  s.tree->update(s.boxes.triangles);
  s.found.clear();
  if (!s.cloth_tree->overlaps(*s.tree, limit, s.rows)) return false;
  remove_static(s.rows, segment, after_);
  return find_obstacle_pairs(s.cloth, s.cloth_boxes, after_, s.boxes, s.rows,
                             {s.x, s.x, s.dhat + segment.chord_error, segment.begin, segment.end}, 0, limit,
                             s.found);
}

double ObstacleTrajectory::smallest_gap(Search& s) const {
  find(segment(0, 0), s, std::numeric_limits<long>::max());
  double gap = s.dhat;
  for (const ContactPair& pair : s.found.pairs) {
    const PairPositions at = positions_of(pair, s.x, before_.vertices);
    gap = std::min(gap, connection(at, closest(pair.kind, at)).norm());
  }
  return gap;
}

StepLimit ObstacleTrajectory::max_step(const Surface& cloth, const Positions& x, double dhat,
                                       BroadPhaseKind broad_phase) const {
  if (is_static()) return {};
  Search search(cloth, x, dhat, broad_phase);
  return max_obstacle_step(dhat, smallest_gap(search), [&](double min_gap, int max_iterations) {
    return advance(search, min_gap, max_iterations);
  });
}

StepLimit ObstacleTrajectory::advance(Search& s, double min_gap, int max_iterations) const {
  long limit = initial_pair_limit;
  for (double time = 0, length = 1; time < 1;) {
    const double end = segment_end(time, std::min(1.0, time + length));
    const TrajectorySegment segment = this->segment(time, end);
    if (!find(segment, s, limit)) {
      length = (end - time) / 4;
      limit *= 2;
      continue;
    }
    std::vector<double> fractions(s.found.pairs.size());
    parallel_for(static_cast<int>(fractions.size()), 64, [&](int begin, int stop) {
      for (int i = begin; i < stop; ++i)
        fractions[i] = PairOnSegment(s.found.pairs[i], s.x, segment, after_).advance(min_gap, max_iterations);
    });
    const auto smallest = std::min_element(fractions.begin(), fractions.end());
    if (smallest != fractions.end() && *smallest < 1)
      return {interpolate<double>(time, end, *smallest),
              name_of(s.found.pairs[smallest - fractions.begin()], after_, static_cast<int>(s.x.rows()))};
    length = 2 * (end - time);
    time = end;
  }
  return {};
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
