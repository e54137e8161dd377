#include "plugins/metric/silhouette/silhouette.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/kernel/linear_algebra/parallel.h"
#include "core/kernel/plugin/plugin.h"

namespace drape {
namespace {

using Projected = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;  // n×2 on the picture plane

/// States that reach over more than so many pixels are seen in larger ones: pictures stay small.
constexpr double max_pixels_a_side = 4096;

/// Which side of the line through a and b the point p is on. The same rounding whichever end is named first,
/// so that no pixel falls between two triangles that share the edge.
double side(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  const bool swapped = b.x() < a.x() || (b.x() == a.x() && b.y() < a.y());
  const Eigen::Vector2d &from = swapped ? b : a, &to = swapped ? a : b;
  const double s = (to.x() - from.x()) * (p.y() - from.y()) - (to.y() - from.y()) * (p.x() - from.x());
  return swapped ? -s : s;
}

/// The triangle with its border, either way round; one that has collapsed to a line covers nothing.
bool covers(const Eigen::Vector2d (&corner)[3], const Eigen::Vector2d& p) {
  const double s[] = {side(corner[0], corner[1], p), side(corner[1], corner[2], p),
                      side(corner[2], corner[0], p)};
  const auto [low, high] = std::minmax({s[0], s[1], s[2]});
  return (low >= 0 && high > 0) || (high <= 0 && low < 0);
}

/// A picture whose pixel (column, row) has its centre there.
struct Picture {
  int columns, rows;
  std::vector<char> pixels;

  Picture(int columns_, int rows_)
      : columns(columns_), rows(rows_), pixels(static_cast<std::size_t>(columns_) * rows_, 0) {}

  /// Sets the bit in every pixel whose centre a triangle covers.
  void draw(const Projected& x, const Triangles& triangles, char bit) {
    for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
      const Eigen::Vector2d corner[3] = {x.row(triangles(t, 0)), x.row(triangles(t, 1)),
                                         x.row(triangles(t, 2))};
      const Eigen::Vector2d lower = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]);
      const Eigen::Vector2d upper = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]);
      const int left = std::max(0, static_cast<int>(std::ceil(lower.x())));
      const int right = std::min(columns - 1, static_cast<int>(std::floor(upper.x())));
      const int bottom = std::max(0, static_cast<int>(std::ceil(lower.y())));
      const int top = std::min(rows - 1, static_cast<int>(std::floor(upper.y())));
      for (int row = bottom; row <= top; ++row)
        for (int column = left; column <= right; ++column)
          if (char& pixel = pixels[static_cast<std::size_t>(row) * columns + column];
              !(pixel & bit) && covers(corner, Eigen::Vector2d(column, row)))
            pixel |= bit;
    }
  }
};

/// Intersection over union of the two silhouettes; 1 where neither covers a pixel.
double overlap(const Positions& x, const Positions& other, const Triangles& triangles,
               const Eigen::Vector3d& direction, double pixel) {
  const Eigen::Vector3d right = direction.unitOrthogonal(), up = direction.cross(right);
  Eigen::Matrix<double, 3, 2> plane;
  plane << right, up;
  Projected a = x * plane, b = other * plane;
  const Eigen::RowVector2d lower = a.colwise().minCoeff().cwiseMin(b.colwise().minCoeff());
  const Eigen::RowVector2d extent = a.colwise().maxCoeff().cwiseMax(b.colwise().maxCoeff()) - lower;
  pixel = std::max(pixel, extent.maxCoeff() / max_pixels_a_side);
  for (Projected* p : {&a, &b}) *p = ((p->rowwise() - lower) / pixel).array() - 0.5;
  Picture picture(std::max(1, static_cast<int>(std::ceil(extent.x() / pixel))),
                  std::max(1, static_cast<int>(std::ceil(extent.y() / pixel))));
  picture.draw(a, triangles, 1);
  picture.draw(b, triangles, 2);
  const auto both = std::count(picture.pixels.begin(), picture.pixels.end(), 3);
  const auto none = std::count(picture.pixels.begin(), picture.pixels.end(), 0);
  const auto either = static_cast<std::ptrdiff_t>(picture.pixels.size()) - none;
  return either == 0 ? 1 : static_cast<double>(both) / static_cast<double>(either);
}

}  // namespace

std::array<Eigen::Vector3d, 12> Silhouette::directions() {
  std::array<Eigen::Vector3d, 12> all;
  const double a = std::sqrt(2.0) - 1;
  int k = 0;
  for (const double s : {a, -a})
    for (const double t : {a, -a}) {
      all[k++] = Eigen::Vector3d(1, s, t).normalized();
      all[k++] = Eigen::Vector3d(t, 1, s).normalized();
      all[k++] = Eigen::Vector3d(s, t, 1).normalized();
    }
  return all;
}

MetricDeclaration Silhouette::declaration() const {
  return {.columns = {{.name = "silhouette_overlap",
                       .label = "silhouette overlap",
                       .unit = "1",
                       .better = Better::higher,
                       .error = "silhouette_mismatch"},
                      {.name = "silhouette_lowest",
                       .label = "silhouette overlap, worst view",
                       .unit = "1",
                       .better = Better::higher,
                       .shown = Shown::stored}},
          .text =
              "Silhouette overlap is intersection over union of the outlines, averaged over twelve views; "
              "higher is better."};
}

MetricResult Silhouette::measure(const MetricInput& input) const {
  const Positions& x = input.x;
  const Positions& other = *input.other;
  const double diagonal = bounding_box_diagonal(input.level.rest.vertices);
  const auto views = directions();
  std::array<double, views.size()> values;
  parallel_for(static_cast<int>(views.size()), 1, [&](int begin, int end) {
    for (int k = begin; k < end; ++k)
      values[k] = overlap(x, other, input.level.rest.triangles, views[k], diagonal / p_.resolution);
  });
  double sum = 0;
  for (const double v : values) sum += v;
  MetricResult result;
  result.values.push_back({"silhouette_overlap", sum / values.size()});
  result.values.push_back({"silhouette_lowest", *std::min_element(values.begin(), values.end())});
  return result;
}

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Metric, drape::Silhouette>(
      "silhouette", "How far the outlines of two states cover each other, from twelve sides.");
}
