#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/numerics/patterns/delaunay.h"

namespace drape {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// Boundary vertices of a rectangle, counter-clockwise from (0, 0), evenly spaced. Fractions are computed
/// before lengths: the last point of a side must equal the corner to the bit.
Points rectangle_border(const Eigen::Vector2d& size, int columns, int rows) {
  Points points;
  for (int i = 0; i < columns; ++i) points.emplace_back(size.x() * (static_cast<double>(i) / columns), 0);
  for (int j = 0; j < rows; ++j) points.emplace_back(size.x(), size.y() * (static_cast<double>(j) / rows));
  for (int i = columns; i > 0; --i)
    points.emplace_back(size.x() * (static_cast<double>(i) / columns), size.y());
  for (int j = rows; j > 0; --j) points.emplace_back(0, size.y() * (static_cast<double>(j) / rows));
  return points;
}

/// Points in square cells, for queries whether a disc is empty.
class CellGrid {
 public:
  CellGrid(const Eigen::Vector2d& size, double cell)
      : cell_(cell), columns_(cells(size.x())), rows_(cells(size.y())), items_(columns_ * rows_) {}

  void add(const Eigen::Vector2d& p) { items_[column(p.x()) + columns_ * row(p.y())].push_back(p); }

  /// Whether no point is closer than radius ≤ cell.
  bool is_free(const Eigen::Vector2d& p, double radius) const {
    const int i = column(p.x()), j = row(p.y());
    for (int r = std::max(j - 1, 0); r <= std::min(j + 1, rows_ - 1); ++r)
      for (int c = std::max(i - 1, 0); c <= std::min(i + 1, columns_ - 1); ++c)
        for (const Eigen::Vector2d& q : items_[c + columns_ * r])
          if ((p - q).squaredNorm() < radius * radius) return false;
    return true;
  }

 private:
  int cells(double length) const { return static_cast<int>(length / cell_) + 1; }
  int column(double x) const { return std::min(static_cast<int>(x / cell_), columns_ - 1); }
  int row(double y) const { return std::min(static_cast<int>(y / cell_), rows_ - 1); }

  double cell_;
  int columns_, rows_;
  std::vector<Points> items_;
};

/// Adds `count` inner points, as far from each other and from the boundary as possible.
void throw_darts(const Eigen::Vector2d& size, double spacing, int count, Random& random, Points& points) {
  constexpr int patience = 400;  // misses before the radius shrinks
  constexpr double shrink = 0.98;
  // Smallest distance to the sides, relative to the radius: less makes slivers there.
  const double border_share = 0.6;
  CellGrid taken(size, spacing);
  for (const Eigen::Vector2d& p : points) taken.add(p);
  double radius = spacing;
  for (int misses = 0; static_cast<int>(points.size()) < count;) {
    const double margin = std::min(border_share * radius, size.minCoeff() / 3);
    const Eigen::Vector2d unit(random.unit(), random.unit());
    const Eigen::Vector2d p = (unit.array() * (size.array() - 2 * margin) + margin).matrix();
    if (taken.is_free(p, radius)) {
      taken.add(p);
      points.push_back(p);
      misses = 0;
    } else if (++misses == patience) {
      radius *= shrink;
      misses = 0;
    }
  }
}

}  // namespace

TriangleMesh random_triangulation(Eigen::Vector2d size, int vertices, unsigned seed) {
  if (!(size.minCoeff() > 0) || !size.allFinite())
    throw std::runtime_error("random triangulation: the size must be positive");
  const double spacing = even_spacing(size.prod(), 2 * size.sum(), std::max(vertices, 1));
  const auto pieces = [&](double length) {
    return std::max(1, static_cast<int>(std::lround(length / spacing)));
  };
  Points points = rectangle_border(size, pieces(size.x()), pieces(size.y()));
  if (vertices < 5 || static_cast<int>(points.size()) >= vertices)
    throw std::runtime_error("random triangulation: " + std::to_string(vertices) +
                             " vertices leave none for the inside of this rectangle; ask for more");
  Random random(seed);
  throw_darts(size, spacing, vertices, random, points);

  TriangleMesh mesh;
  mesh.vertices.setZero(vertices, 3);
  for (int v = 0; v < vertices; ++v) mesh.vertices.row(v).head<2>() = points[v].transpose();
  mesh.triangles = delaunay_triangulation(points);
  return mesh;
}

}  // namespace drape
