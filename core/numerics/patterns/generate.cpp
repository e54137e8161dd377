#include "core/numerics/patterns/generate.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/numerics/patterns/delaunay.h"

namespace drape {

TriangleMesh grid(Eigen::Vector2d size, int columns, int rows, Diagonals diagonals) {
  if (!(size.minCoeff() > 0) || !size.allFinite())
    throw std::runtime_error("grid: the size must be positive");
  if (columns < 2 || rows < 2) throw std::runtime_error("grid: at least 2 × 2 vertices are needed");

  TriangleMesh mesh;
  mesh.vertices.resize(static_cast<Eigen::Index>(columns) * rows, 3);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      mesh.vertices.row(i + columns * j) << size.x() * i / (columns - 1), size.y() * j / (rows - 1), 0;

  mesh.triangles.resize(2 * static_cast<Eigen::Index>(columns - 1) * (rows - 1), 3);
  Eigen::Index t = 0;
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i + 1 < columns; ++i) {
      const int a = i + columns * j, b = a + 1, c = b + columns, d = a + columns;  // counter-clockwise
      if (diagonals == Diagonals::one_way || (i + j) % 2 == 0) {
        mesh.triangles.row(t++) << a, b, c;
        mesh.triangles.row(t++) << a, c, d;
      } else {
        mesh.triangles.row(t++) << a, b, d;
        mesh.triangles.row(t++) << b, c, d;
      }
    }
  return mesh;
}

TriangleMesh disc(double radius, int vertices_about) {
  if (!(radius > 0) || !std::isfinite(radius)) throw std::runtime_error("disc: the radius must be positive");
  const double pi = std::numbers::pi;
  const double spacing = even_spacing(pi * radius * radius, 2 * pi * radius, std::max(vertices_about, 3));
  const auto sides = std::max(6L, std::lround(2 * pi * radius / spacing));
  Polygon circle;
  for (long i = 0; i < sides; ++i) {
    const double angle = 2 * pi * static_cast<double>(i) / static_cast<double>(sides);
    circle.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return delaunay_polygon({circle}, vertices_about, 0);
}

}  // namespace drape
