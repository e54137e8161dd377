#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/numerics/patterns/delaunay.h"
#include "core/numerics/patterns/plane_grid.h"

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

/// Adds `count` inner points, as far from each other and from the boundary as possible.
void throw_darts(const Eigen::Vector2d& size, double spacing, int count, Random& random, Points& points) {
  constexpr int patience = 400;  // misses before the radius shrinks
  constexpr double shrink = 0.98;
  // Smallest distance to the sides, relative to the radius: less makes slivers there.
  const double border_share = 0.6;
  PlaneGrid taken(Eigen::Vector2d::Zero(), size, spacing);
  for (int i = 0; i < std::ssize(points); ++i) taken.add(i, points[i], points[i]);
  const auto is_free = [&](const Eigen::Vector2d& p, double radius) {
    const Eigen::Vector2d reach(radius, radius);
    bool free = true;
    taken.for_each(p - reach, p + reach,
                   [&](int i) { free = free && (p - points[i]).squaredNorm() >= radius * radius; });
    return free;
  };
  double radius = spacing;
  for (int misses = 0; static_cast<int>(points.size()) < count;) {
    const double margin = std::min(border_share * radius, size.minCoeff() / 3);
    const Eigen::Vector2d unit(random.unit(), random.unit());
    const Eigen::Vector2d p = (unit.array() * (size.array() - 2 * margin) + margin).matrix();
    if (is_free(p, radius)) {
      taken.add(static_cast<int>(points.size()), p, p);
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
