#include "core/numerics/sewing/mesh_panel.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/numerics/patterns/delaunay.h"

namespace drape {

namespace {

using Eigen::Vector2d;

/// Signed, positive where the loop runs counter-clockwise.
double area_of(const Polygon& loop) {
  double twice = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector2d a = loop[i] - loop[0], b = loop[(i + 1) % loop.size()] - loop[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

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

/// Whether a side from a to b crosses the line to the right of a point.
bool crosses(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  return (a.y() > p.y()) != (b.y() > p.y()) &&
         p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x();
}

/// The sides of a region's loops, by the rows of a lattice that they are near to.
class RowsOfSides {
 public:
  RowsOfSides(const std::vector<Polygon>& loops, double middle, double height, long rows, double gap)
      : rows_(rows), of_row_(static_cast<std::size_t>(2 * rows + 1)), gap_(gap) {
    for (const Polygon& loop : loops)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Side side{loop[i], loop[(i + 1) % loop.size()]};
        const auto [low, high] = std::minmax(side.a.y(), side.b.y());
        const auto row_of = [&](double y) {
          return std::clamp(std::round((y - middle) / height), -double(rows), double(rows));
        };
        // A row's points are moved by less than its height.
        const auto first = static_cast<long>(row_of(low - gap)) - 1,
                   last = static_cast<long>(row_of(high + gap)) + 1;
        for (long j = std::max(first, -rows); j <= std::min(last, rows); ++j)
          of_row_[j + rows_].push_back(side);
      }
  }

  /// From the leftmost to the rightmost end of the row's sides; nothing without any.
  std::optional<std::pair<double, double>> extent(long row) const {
    if (of_row_[row + rows_].empty()) return std::nullopt;
    double left = std::numeric_limits<double>::infinity(), right = -left;
    for (const Side& side : of_row_[row + rows_]) {
      left = std::min({left, side.a.x(), side.b.x()});
      right = std::max({right, side.a.x(), side.b.x()});
    }
    return std::pair(left, right);
  }

  /// Whether a point of the row is in the region and farther from its border than the gap.
  bool has_well_inside(long row, const Vector2d& p) const {
    bool inside = false;
    for (const auto& [a, b] : of_row_[row + rows_]) {
      if (crosses(a, b, p)) inside = !inside;
      const Vector2d along = b - a;
      const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
      if ((p - a - t * along).norm() < gap_) return false;
    }
    return inside;
  }

 private:
  struct Side {
    Vector2d a, b;
  };
  long rows_;
  std::vector<std::vector<Side>> of_row_;
  double gap_;
};

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
  const double height = edge_length * std::numbers::sqrt3 / 2;
  const auto rows = static_cast<long>(std::ceil(box.sizes().y() / (2 * height)));
  const RowsOfSides sides(loops, box.center().y(), height, rows, gap * edge_length);
  for (long j = -rows; j <= rows; ++j) {
    const auto extent = sides.extent(j);
    if (!extent) continue;
    const auto column = [&](double x) { return std::lround((x - box.center().x()) / (edge_length / 2)); };
    for (long i = column(extent->first); i <= column(extent->second); ++i) {
      if ((i + j) % 2 != 0) continue;  // i counts half edges
      const double across = static_cast<double>(i) / 2 + moved * scattered(i, j);
      const double along = static_cast<double>(j) + moved * scattered(j, i);
      const Vector2d p = box.center() + Vector2d(across * edge_length, along * height);
      if (sides.has_well_inside(j, p)) points.push_back(p);
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
    if (crosses(loop[i], loop[(i + 1) % loop.size()], p)) inside = !inside;
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
  for (int round = 0; round < rounds; ++round) {
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
