#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/numerics/patterns/delaunay.h"
#include "core/numerics/sewing/panel_meshes.h"

namespace drape {

namespace {

using Eigen::Vector2d;

/// Whether the loop leans to the left of the middle of its box. Its mirrored loop leans to the right, unless
/// it is symmetric.
bool leans_left(const Polygon& loop, double middle) {
  double moment = 0;  // the third moment of the sides: it differs where the first one does not
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector2d &a = loop[i], &b = loop[(i + 1) % loop.size()];
    const double x = (a.x() + b.x()) / 2 - middle;
    moment += (b - a).norm() * (x + x * x * x);
  }
  return moment < 0;
}

/// The x at which a side from a to b crosses the line of this y.
std::optional<double> crossing(const Vector2d& a, const Vector2d& b, double y) {
  if ((a.y() > y) == (b.y() > y)) return std::nullopt;
  return (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()) + a.x();
}

/// A side of a region's loops.
struct Side {
  Vector2d a, b;
  double left() const { return std::min(a.x(), b.x()); }
};

/// Whether one of the sides, which lie from left to right, is nearer to a point than the gap.
bool is_near(const std::vector<Side>& sides, double widest, const Vector2d& p, double gap) {
  for (auto side = std::ranges::lower_bound(sides, p.x() - gap - widest, {}, &Side::left);
       side != sides.end() && side->left() <= p.x() + gap; ++side) {
    const Vector2d along = side->b - side->a;
    const double t = std::clamp((p - side->a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    if ((p - side->a - t * along).norm() < gap) return true;
  }
  return false;
}

/// A number from -1 to 1 that looks random, of two integers.
double scattered(long i, long j) {
  const auto mixed = static_cast<unsigned long>(i * 73856093L + j * 19349663L);
  return static_cast<double>((mixed * 2654435761UL >> 7) % 1024UL) / 511.5 - 1;
}

/// The points of an equilateral lattice about the middle of the region's box that lie well inside. They are
/// moved a little: points on a common circle have several Delaunay triangulations, of which rounding would
/// choose.
Polygon lattice(const std::vector<Polygon>& loops, const Eigen::AlignedBox2d& box, double edge_length) {
  constexpr double gap = 0.6;     // of an edge: triangles at the border are about as high as others
  constexpr double moved = 0.02;  // of an edge
  Polygon points;
  const double height = edge_length * std::numbers::sqrt3 / 2, near = gap * edge_length;
  const auto last = static_cast<long>(std::ceil(box.sizes().y() / (2 * height)));
  std::vector<std::vector<Side>> rows(static_cast<std::size_t>(2 * last + 1));  // the sides near to each
  for (const Polygon& loop : loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Side side{loop[i], loop[(i + 1) % loop.size()]};
      const auto [low, high] = std::minmax(side.a.y(), side.b.y());
      const auto row_of = [&](double y) {
        return static_cast<long>(
            std::clamp(std::round((y - box.center().y()) / height), -double(last), double(last)));
      };
      // A row's points are moved by less than its height.
      for (long j = std::max(row_of(low - near) - 1, -last); j <= std::min(row_of(high + near) + 1, last);
           ++j)
        rows[j + last].push_back(side);
    }
  for (long j = -last; j <= last; ++j) {
    std::vector<Side>& sides = rows[j + last];
    std::ranges::sort(sides, {}, &Side::left);
    std::vector<double> crossings;
    double widest = 0;
    for (const auto& [a, b] : sides) {
      widest = std::max(widest, std::abs(b.x() - a.x()));
      if (const auto x = crossing(a, b, box.center().y() + static_cast<double>(j) * height))
        crossings.push_back(*x);
    }
    std::ranges::sort(crossings);
    const auto column = [&](double x) { return std::lround((x - box.center().x()) / (edge_length / 2)); };
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
      const double left = crossings[k], right = crossings[k + 1];
      for (long i = column(left) - 1; i <= column(right) + 1; ++i) {
        if ((i + j) % 2 != 0) continue;  // i counts half edges
        const double across = static_cast<double>(i) / 2 + moved * scattered(i, j);
        const double along = static_cast<double>(j) + moved * scattered(j, i);
        const Vector2d p = box.center() + Vector2d(across * edge_length, along * height);
        // Between the row and a point that is far from all sides there is none: both are on one side of each.
        if (left < p.x() && p.x() < right && !is_near(sides, widest, p, near)) points.push_back(p);
      }
    }
  }
  return points;
}

/// Moves each inner point to the mean of its neighbours, which evens the triangles out.
void smooth(Polygon& points, std::size_t first_inner, const Triangles& triangles) {
  Polygon sum(points.size(), Vector2d::Zero());
  std::vector<double> count(points.size(), 0);
  for (const auto& t : triangles.rowwise())
    for (int k = 0; k < 3; ++k)
      for (const int other : {t[(k + 1) % 3], t[(k + 2) % 3]}) sum[t[k]] += points[other], ++count[t[k]];
  for (std::size_t v = first_inner; v < points.size(); ++v)
    if (count[v] > 0) points[v] = sum[v] / count[v];
}

}  // namespace

bool is_inside(const Polygon& loop, const Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i)
    if (const auto x = crossing(loop[i], loop[(i + 1) % loop.size()], p.y()); x && p.x() < *x)
      inside = !inside;
  return inside;
}

TriangleMesh mesh_panel(const std::vector<Polygon>& loops, double edge_length) {
  constexpr int rounds = 8;  // of smoothing: more hardly change a mesh of 2 cm
  std::vector<Polygon> own = loops;
  Eigen::AlignedBox2d box;
  for (const Vector2d& p : own[0]) box.extend(p);
  const bool mirrored = leans_left(own[0], box.center().x());
  if (mirrored)
    for (Polygon& loop : own)
      for (Vector2d& p : loop) p.x() = 2 * box.center().x() - p.x();
  auto [points, border, loop_of] = sides_of(own);
  const std::size_t first_inner = points.size();
  for (const Vector2d& p : lattice(own, box, edge_length)) points.push_back(p);
  Triangles triangles = triangles_within(points, border);
  for (int round = 0; round < rounds && first_inner < points.size(); ++round) {
    smooth(points, first_inner, triangles);
    triangles = triangles_within(points, border);
  }
  // Counter-clockwise as the outline runs: the mirrored triangles of a mirrored loop are clockwise.
  if (mirrored != (area_of(loops[0]) < 0)) triangles.col(1).swap(triangles.col(2));
  TriangleMesh mesh{Positions::Zero(std::ssize(points), 3), triangles};
  for (std::size_t v = 0; v < points.size(); ++v) {
    mesh.vertices.row(static_cast<Eigen::Index>(v)).head<2>() = points[v].transpose();
    if (mirrored) mesh.vertices(static_cast<Eigen::Index>(v), 0) = 2 * box.center().x() - points[v].x();
  }
  for (std::size_t v = 0, k = 0; k < loops.size(); ++k)
    for (const Vector2d& p : loops[k])
      mesh.vertices.row(static_cast<Eigen::Index>(v++)).head<2>() = p.transpose();
  return mesh;
}

}  // namespace drape
