#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/numerics/patterns/generate.h"

namespace drape {
namespace {

const double height_of_unit = std::sqrt(0.75);  // height of an equilateral triangle of side 1

/// Vertices of `rows` rows, of which every other one has a vertex more.
double vertex_count(double columns, double rows) { return columns * rows + std::floor(rows / 2); }

/// Relative deviation of the rows' distance from that of equilateral triangles.
double distortion(const Eigen::Vector2d& size, double columns, double rows) {
  return std::abs(size.y() / (rows - 1) / (height_of_unit * size.x() / (columns - 1)) - 1);
}

int rows_for(const Eigen::Vector2d& size, double columns, double most) {
  const double strips = std::round(size.y() * (columns - 1) / (height_of_unit * size.x()));
  return static_cast<int>(std::clamp(strips + 1, 2.0, std::max(2.0, most)));
}

int columns_for(const Eigen::Vector2d& size, double rows, double most) {
  const double sides = std::round(size.x() * (rows - 1) * height_of_unit / size.y());
  return static_cast<int>(std::clamp(sides + 1, 2.0, std::max(2.0, most)));
}

}  // namespace

Eigen::Vector2i equilateral_counts(const Eigen::Vector2d& size, int vertices, int columns, int rows) {
  constexpr double most = 1e9;  // of a derived count
  if (columns > 0 && rows > 0) return {columns, rows};
  if (columns > 0) return {columns, rows_for(size, columns, most)};
  if (rows > 0) return {columns_for(size, rows, most), rows};

  // Both counts are rounded: try their neighbours for the best number and shape.
  const double guess = std::sqrt(vertices * height_of_unit * (size.x() / size.y()));
  const double largest = std::max(2.0, vertices / 2.0);
  const int first = static_cast<int>(std::clamp(0.5 * guess - 2, 2.0, largest));
  const int last = static_cast<int>(std::clamp(1.5 * guess + 2, 2.0, largest));
  Eigen::Vector2i best(2, 2);
  double least = std::numeric_limits<double>::infinity();
  for (int c = first; c <= last; ++c) {
    const int r = rows_for(size, c, vertices / (c + 0.5));
    const double miss = std::abs(vertex_count(c, r) / vertices - 1) + distortion(size, c, r);
    if (miss < least) least = miss, best = {c, r};
  }
  return best;
}

TriangleMesh equilateral(const Eigen::Vector2d& size, int columns, int rows) {
  if (!(size.minCoeff() > 0) || !size.allFinite())
    throw std::runtime_error("equilateral: the size must be positive");
  if (columns < 2 || rows < 2) throw std::runtime_error("equilateral: at least 2 × 2 vertices are needed");

  TriangleMesh mesh;
  const Eigen::Index sides = columns - 1, strips = rows - 1;
  mesh.vertices.resize(static_cast<Eigen::Index>(columns) * rows + rows / 2, 3);
  mesh.triangles.resize(strips * (2 * sides + 1), 3);
  Eigen::Index v = 0, t = 0;
  for (int j = 0; j < rows; ++j) {
    const bool shifted = j % 2 == 1;
    const int row_start = static_cast<int>(v), count = columns + shifted;
    for (int i = 0; i < count; ++i) {
      const double place = shifted ? std::clamp(i - 0.5, 0.0, static_cast<double>(sides)) : i;
      mesh.vertices.row(v++) << size.x() * (place / sides), size.y() * (static_cast<double>(j) / strips), 0;
    }
    if (j == 0) continue;
    // `wide` is the row with the additional vertex; w_i, w_{i+1} lie on either side of n_i.
    const int below = row_start - (columns + !shifted), above = row_start;
    const int wide = shifted ? above : below, narrow = shifted ? below : above;
    for (int i = 0; i < columns; ++i) {
      const int n = narrow + i, w = wide + i;
      if (shifted)
        mesh.triangles.row(t++) << n, w + 1, w;
      else
        mesh.triangles.row(t++) << w, w + 1, n;
      if (i + 1 == columns) continue;
      if (shifted)
        mesh.triangles.row(t++) << n, n + 1, w + 1;
      else
        mesh.triangles.row(t++) << n, w + 1, n + 1;
    }
  }
  return mesh;
}

}  // namespace drape
