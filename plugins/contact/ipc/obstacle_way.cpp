#include "plugins/contact/ipc/obstacle_way.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/contact/bent_advance.h"
#include "core/contact/pair_geometry.h"
#include "core/mesh/rotation.h"
#include "core/mesh/same_triangles.h"
#include "core/numerics/parallel.h"

namespace drape {
namespace {

using Eigen::Vector3d;

constexpr double degree = M_PI / 180, longest_turn = 0.1;
constexpr long many_pairs = 100'000;  // on one leg: fewer come near on shorter ones, most often

template <class T>
T between(const T& a, const T& b, double t) {
  return (1 - t) * a + t * b;
}

/// 0 at a and 1 at b, exactly.
Pose between(const Pose& a, const Pose& b, double t) {
  return {between<double>(a.scale, b.scale, t), between<Vector3d>(a.rotate, b.rotate, t),
          between<Vector3d>(a.translate, b.translate, t)};
}

/// Bounds how fast a pose turns, in radians a leg.
double turning(const Pose& a, const Pose& b) { return degree * (b.rotate - a.rotate).cwiseAbs().sum(); }

Positions placed(const Positions& own, const Pose& pose) {
  return (own * pose.linear().transpose()).rowwise() + pose.translate.transpose();
}

/// A pair whose obstacle's side follows a leg.
class PairOnLeg {
 public:
  PairOnLeg(const ContactPair& pair, const Positions& x, const Leg& leg, const Obstacles& obstacles)
      : pair_(pair), leg_(leg), cloth_count_(static_cast<int>(x.rows())) {
    for (int k = 0; k < 4; ++k) {
      const int v = pair.vertices[k] - cloth_count_;
      if (v < 0) {
        start_.col(k) = x.row(pair.vertices[k]);
      } else {
        body_ = obstacles.body_of(v);
        start_.col(k) = leg.from.row(v);
        bend_ = std::max(bend_, leg.bend(body_, v));
        chord_ = std::max(chord_, (leg.to.row(v) - leg.from.row(v)).norm());
      }
    }
    rounding_ = 32 * std::numeric_limits<double>::epsilon() * (start_.cwiseAbs().maxCoeff() + chord_ + bend_);
  }

  /// The part of the leg on which the gap is at least `kept`.
  double advance(double kept, int rounds) const {
    if (box_distance(pair_.kind, start_) - rounding_ >= kept + chord_ + bend_ / 8) return 1;
    const auto widest = [&](double t) {
      const PairPositions now = at(t);
      const Vector3d n = separating_direction(now, closest(pair_.kind, now));
      return Slab{n, width(now, n)};
    };
    return bent_advance(
        widest, [&](const Vector3d& n, double t) { return width(at(t), n); }, kept, bend_, rounds);
  }

 private:
  PairPositions at(double t) const {
    PairPositions now = start_;
    if (t == 0) return now;
    if (t == 1) {
      for (int k = 0; k < 4; ++k)
        if (const int v = pair_.vertices[k] - cloth_count_; v >= 0) now.col(k) = leg_.to.row(v);
      return now;
    }
    const Eigen::Matrix3d linear = leg_.linear(body_, t);
    const Vector3d translate = leg_.translate(body_, t);
    for (int k = 0; k < 4; ++k)
      if (const int v = pair_.vertices[k] - cloth_count_; v >= 0)
        now.col(k) = linear * between<Vector3d>(leg_.own_from.row(v), leg_.own_to.row(v), t) + translate;
    return now;
  }

  /// n points from the second side to the first.
  double width(const PairPositions& now, const Vector3d& n) const {
    double least = std::numeric_limits<double>::infinity();
    for (int a = 0; a < first_side(pair_.kind); ++a)
      for (int b = first_side(pair_.kind); b < 4; ++b)
        least = std::min(least, n.dot(now.col(a) - now.col(b)));
    return least - rounding_;
  }

  const ContactPair& pair_;
  const Leg& leg_;
  int cloth_count_, body_ = 0;
  PairPositions start_;
  double bend_ = 0, chord_ = 0, rounding_;
};

/// Takes the triangles of bodies that stand still out of the rows.
void leave_moving(AdjacencyList& rows, const Leg& leg, const Obstacles& obstacles) {
  int kept = 0;
  for (std::size_t row = 0; row + 1 < rows.start.size(); ++row) {
    const int begin = rows.start[row];
    rows.start[row] = kept;
    for (int i = begin; i < rows.start[row + 1]; ++i)
      if (leg.bodies[obstacles.body_of(obstacles.surface.triangles(rows.items[i], 0))].moves)
        rows.items[kept++] = rows.items[i];
  }
  rows.start.back() = kept;
  rows.items.resize(kept);
}

}  // namespace

Eigen::Matrix3d Leg::linear(int body, double time) const {
  const Body& b = bodies[body];
  if (b.from.rotate == b.to.rotate) return between(b.from.scale, b.to.scale, time) * b.turn;
  return between(b.from, b.to, time).linear();
}

Vector3d Leg::translate(int body, double time) const {
  return between<Vector3d>(bodies[body].from.translate, bodies[body].to.translate, time);
}

// p = s R b + T with s, b and the angles of R linear: |R'| ≤ ω, |R''| ≤ ω², ω the sum of the angles' rates.
double Leg::bend(int body, int vertex) const {
  const Body& b = bodies[body];
  const double omega = turning(b.from, b.to), scale = std::max(b.from.scale, b.to.scale),
               scaling = std::abs(b.to.scale - b.from.scale),
               size = std::max(own_from.row(vertex).norm(), own_to.row(vertex).norm()),
               growth = (own_to.row(vertex) - own_from.row(vertex)).norm();
  return omega * omega * scale * size +
         2 * (scaling * omega * size + scale * omega * growth + scaling * growth);
}

ObstacleWay::ObstacleWay(const Obstacles& before, const Obstacles& after) : before_(before), after_(after) {
  if (before.bodies.size() != after.bodies.size())
    throw std::runtime_error("obstacles cannot appear or vanish during a run");
  for (std::size_t i = 0; i < after.bodies.size(); ++i) {
    const Obstacle &from = before.bodies[i], &to = after.bodies[i];
    if (!same_triangles(from.mesh.triangles, to.mesh.triangles))
      throw std::runtime_error("obstacle \"" + to.name + "\": its mesh has become another one, of " +
                               std::to_string(to.mesh.triangles.rows()) + " triangles and not " +
                               std::to_string(from.mesh.triangles.rows()) +
                               "; during a run it may move, turn, grow and change its frame alone");
    moves_.push_back(!(from.form == to.form));
  }
}

bool ObstacleWay::is_still() const { return std::find(moves_.begin(), moves_.end(), 1) == moves_.end(); }

double ObstacleWay::leg_end(double begin, double end) const {
  for (std::size_t i = 0; i < moves_.size(); ++i) {
    if (!moves_[i]) continue;
    const Form &from = before_.bodies[i].form, &to = after_.bodies[i].form;
    if (const double turn = turning(from.pose, to.pose); turn > 0)
      end = std::min(end, begin + longest_turn / turn);
    if (from.frames != to.frames || from.frame == to.frame) continue;
    const double rate = to.frame - from.frame, now = from.frame + begin * rate;
    // Past a file by less than rounding counts as at it.
    const double next = rate > 0 ? std::floor(now + 1e-12) + 1 : std::ceil(now - 1e-12) - 1;
    end = std::min(end, std::max((next - from.frame) / rate, begin + 1e-12));
  }
  return end;
}

Leg ObstacleWay::leg(double begin, double end) const {
  Leg leg;
  leg.own_from.resize(before_.vertices.rows(), 3);
  leg.own_to.resize(before_.vertices.rows(), 3);
  leg.from = leg.to = before_.vertices;
  for (std::size_t i = 0; i < moves_.size(); ++i) {
    Leg::Body& body = leg.bodies.emplace_back();
    body.moves = moves_[i] != 0;
    if (!body.moves) continue;
    const Form &from = before_.bodies[i].form, &to = after_.bodies[i].form;
    body.from = between(from.pose, to.pose, begin);
    body.to = between(from.pose, to.pose, end);
    body.turn = rotation_matrix(body.from.rotate);
    const auto own_at = [&](double t) {
      if (from.frames == to.frames && from.stretch == to.stretch)
        return from.own_places(between<double>(from.frame, to.frame, t));
      return between<Positions>(from.own_places(from.frame), to.own_places(to.frame), t);
    };
    const int first = before_.first_vertex[i], count = before_.first_vertex[i + 1] - first;
    leg.own_from.middleRows(first, count) = own_at(begin);
    leg.own_to.middleRows(first, count) = own_at(end);
    leg.from.middleRows(first, count) = placed(leg.own_from.middleRows(first, count), body.from);
    leg.to.middleRows(first, count) = placed(leg.own_to.middleRows(first, count), body.to);
    for (int v = first; v < first + count; ++v)
      leg.off_chord = std::max(leg.off_chord, leg.bend(static_cast<int>(i), v) / 8);
  }
  return leg;
}

/// What is looked for, and what was found on the last leg.
struct ObstacleWay::Search {
  Search(const Surface& cloth, const Positions& x, double range, BroadPhaseKind kind)
      : cloth(cloth), x(x), range(range), cloth_tree(make_broad_phase(kind)), tree(make_broad_phase(kind)) {
    cloth_boxes.update(cloth, x, x, 0.5 * range);
    cloth_tree->update(cloth_boxes.triangles);
  }

  const Surface& cloth;
  const Positions& x;
  double range;
  std::unique_ptr<BroadPhase> cloth_tree, tree;
  SweptBoxes cloth_boxes, boxes;
  AdjacencyList rows;
  FoundPairs found;
};

/// The pairs that come within the range on a leg; false if there are more than `limit`.
bool ObstacleWay::find(const Leg& leg, Search& s, long limit) const {
  s.boxes.update(after_.surface, leg.from, leg.to, 0.5 * s.range + leg.off_chord);
  s.tree->update(s.boxes.triangles);
  s.found.clear();
  if (!s.cloth_tree->overlaps(*s.tree, limit, s.rows)) return false;
  leave_moving(s.rows, leg, after_);
  return find_obstacle_pairs(s.cloth, s.cloth_boxes, after_, s.boxes, s.rows,
                             {s.x, s.x, s.range + leg.off_chord, leg.from, leg.to}, 0, limit, s.found);
}

double ObstacleWay::smallest_gap(Search& s) const {
  find(leg(0, 0), s, std::numeric_limits<long>::max());
  double gap = s.range;
  for (const ContactPair& pair : s.found.pairs) {
    const PairPositions at = positions_of(pair, s.x, before_.vertices);
    gap = std::min(gap, connection(at, closest(pair.kind, at)).norm());
  }
  return gap;
}

StepLimit ObstacleWay::max_move(const Surface& cloth, const Positions& x, double range,
                                BroadPhaseKind broad_phase) const {
  if (is_still()) return {};
  Search search(cloth, x, range, broad_phase);
  const double kept = gap_left_by_moves(range, smallest_gap(search));
  StepLimit whole = advance(search, left_by_whole * kept, rounds_of_whole);
  if (whole.fraction == 1) return {};
  StepLimit part = advance(search, kept, rounds_of_part);
  return part.fraction < whole.fraction ? part : whole;
}

StepLimit ObstacleWay::advance(Search& s, double kept, int rounds) const {
  long limit = many_pairs;
  for (double time = 0, length = 1; time < 1;) {
    const double end = leg_end(time, std::min(1.0, time + length));
    const Leg leg = this->leg(time, end);
    if (!find(leg, s, limit)) {
      length = (end - time) / 4;
      limit *= 2;
      continue;
    }
    std::vector<double> parts(s.found.pairs.size());
    parallel_for(static_cast<int>(parts.size()), 64, [&](int begin, int stop) {
      for (int i = begin; i < stop; ++i)
        parts[i] = PairOnLeg(s.found.pairs[i], s.x, leg, after_).advance(kept, rounds);
    });
    const auto least = std::min_element(parts.begin(), parts.end());
    if (least != parts.end() && *least < 1)
      return {between<double>(time, end, *least),
              name_of(s.found.pairs[least - parts.begin()], after_, static_cast<int>(s.x.rows()))};
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

}  // namespace drape
