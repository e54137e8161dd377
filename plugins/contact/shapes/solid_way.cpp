#include "plugins/contact/shapes/solid_way.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/contact/bent_advance.h"
#include "core/contact/contact_kernel.h"
#include "core/contact/mean_moves.h"

namespace drape {

namespace {

using Eigen::Vector3d;

template <class T>
T between(const T& a, const T& b, double t) {
  return (1 - t) * a + t * b;
}

/// Of the points that turn with the axes, the farthest from the centre; balls about them do not.
double arm(const Solid& s) {
  return s.kind == SolidKind::cylinder ? std::hypot(s.radius, s.half.z()) : s.half.norm();
}

/// A lower bound of a triangle's distance, by the ball around it.
double distance_of_ball(const Solid& solid, const Corners& triangle) {
  const Vector3d middle = (triangle[0] + triangle[1] + triangle[2]) / 3;
  double radius = 0;
  for (const Vector3d& corner : triangle) radius = std::max(radius, (corner - middle).norm());
  return solid.distance(middle) - radius;
}

/// The first t in [0, 1] at which a + b t + c t² is not positive, 1 if there is none.
double first_root(double a, double b, double c) {
  if (!(a > 0)) return 0;
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0 || (b >= 0 && c >= 0)) return 1;
  // a > 0: the positive root nearest to 0, without cancellation in either case.
  const double root = std::sqrt(discriminant);
  const double t = b < 0 ? 2 * a / (root - b) : (-b - root) / (2 * c);
  return t > 0 ? std::min(t, 1.0) : 1;
}

}  // namespace

// p = c + R q with q and the angles of R linear in t: |R'| ≤ ω, |R''| ≤ ω², ω the sum of the angles' changes.
SolidWay::SolidWay(const Solid& from, const Solid& to) : from_(from), to_(to) {
  const double omega = (to.turn - from.turn).cwiseAbs().sum() * (M_PI / 180);
  const double size = std::max(arm(from), arm(to));
  const double growth = (to.half - from.half).norm() + std::abs(to.radius - from.radius);
  bend_ = omega * omega * size + 2 * omega * growth;
  reach_ = (to.centre - from.centre).norm() + omega * size + growth;
}

bool SolidWay::is_still() const {
  return from_.centre == to_.centre && from_.half == to_.half && from_.radius == to_.radius &&
         (from_.kind == SolidKind::half_space ? from_.plane == to_.plane : from_.turn == to_.turn);
}

Solid SolidWay::at(double t) const {
  Solid s;
  s.kind = from_.kind;
  s.centre = between(from_.centre, to_.centre, t);
  s.half = between(from_.half, to_.half, t);
  s.radius = between(from_.radius, to_.radius, t);
  s.turn = between(from_.turn, to_.turn, t);
  s.orient();
  return s;
}

double SolidWay::gap(const Corners& triangle, double range) const {
  const double far = distance_of_ball(from_, triangle);
  return far > range ? far : separate(from_, triangle).gap;
}

double SolidWay::advance(const Corners& triangle, double kept, int rounds) const {
  if (!(kept > 0)) return 0;
  if (from_.kind == SolidKind::half_space) return advance_plane(triangle, kept);
  if (distance_of_ball(from_, triangle) > reach_ + 2 * kept) return 1;
  const auto widest = [&](double t) {
    const Separation s = separate(at(t), triangle);
    return Slab{s.normal, s.gap};
  };
  const auto width = [&](const Vector3d& n, double t) { return slab(at(t), triangle, n); };
  return bent_advance(widest, width, kept, bend_, rounds);
}

// With the normal's length at most what it is between its ends, (gap - kept) |N| ≥ N · (p - c) - kept |N| is
// a polynomial of second degree.
double SolidWay::advance_plane(const Corners& triangle, double kept) const {
  const double length = from_.plane.norm(), longer = to_.plane.norm() - length;
  const Vector3d turn = to_.plane - from_.plane, move = to_.centre - from_.centre;
  double part = 1;
  for (const Vector3d& corner : triangle) {
    const Vector3d p = corner - from_.centre;
    part = std::min(part, first_root(from_.plane.dot(p) - kept * length,
                                     turn.dot(p) - from_.plane.dot(move) - kept * longer, -turn.dot(move)));
  }
  return part;
}

std::vector<SolidWay> ways_of(const std::vector<Solid>& from, const std::vector<Solid>& to) {
  if (from.size() != to.size()) throw std::runtime_error("shapes cannot appear or vanish during a run");
  std::vector<SolidWay> ways;
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (from[i].kind != to[i].kind)
      throw std::runtime_error(to[i].name + " cannot become what it is during a run: it was " + from[i].name);
    ways.emplace_back(from[i], to[i]);
  }
  return ways;
}

void carry_with_solids(const ShapeScene& scene, const std::vector<Solid>& to, const Positions& x,
                       Positions& from) {
  MeanMoves moves(x.rows());  // by friction's force
  const auto add = [&](int vertex, int solid, const Vector3d& touched, double weight) {
    const Vector3d local = scene.solids[solid].to_local(touched);
    moves.add(vertex, to[solid].to_world(local) - touched, weight);
  };
  const ShapeCandidates near = find_candidates(scene, find_triangles(scene, x, x), x, x);
  const double range = scene.barrier.range;
  for (const VertexPair& pair : near.vertices) {
    const Vector3d p = x.row(pair.vertex);
    const Solid& solid = scene.solids[pair.solid];
    const Nearest nearest = solid.nearest(p);
    if (nearest.distance < range && solid.friction > 0)
      add(pair.vertex, pair.solid, p - nearest.distance * nearest.normal,
          -pair.weight * solid.friction * barrier(nearest.distance / range).first);
  }
  const int n = static_cast<int>(x.rows());
  for (const ContactPair& pair : near.pairs) {
    const PairPositions at = positions_of(pair, x, scene.obstacle_points);
    if (pair.friction == 0 || !within_range(pair, at, range)) continue;
    const Contact contact = contact_at(pair, at, range);
    const bool first_is_cloth = pair.vertices[0] < n;
    Vector3d touched = (first_is_cloth ? 1 : -1) * pair.offset * contact.normal;
    for (int k = 0; k < 4; ++k)
      if (pair.vertices[k] >= n) touched += std::abs(contact.closest.c[k]) * at.col(k);
    const int solid = scene.solid_of_point[pair.vertices[first_is_cloth ? 3 : 0] - n];
    for (int k = 0; k < 4; ++k)
      if (pair.vertices[k] < n)
        add(pair.vertices[k], solid, touched,
            std::abs(contact.closest.c[k]) * pair.friction * contact.pressure());
  }
  moves.move(from);
}

}  // namespace drape
