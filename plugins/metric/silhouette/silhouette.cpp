#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/kernel/interfaces/metric.h"
#include "core/kernel/plugin/parameters.h"
#include "core/kernel/plugin/plugin.h"
#include "core/kernel/threads/parallel.h"

namespace drape {
namespace {

using Projected = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;  // n×2 on the picture plane

/// Most pixels across a state; a larger state is seen in larger pixels, so that pictures stay small.
constexpr double max_pixels_a_side = 4096;

/// The line through two corners of a triangle. A point's side is rounded in the same way, but for the sign,
/// whichever corner is named first, so that no pixel falls between two triangles that share the edge.
struct Line {
  double x, y, dx, dy;

  Line(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const bool swapped = b.x() < a.x() || (b.x() == a.x() && b.y() < a.y());
    const Eigen::Vector2d &from = swapped ? b : a, &to = swapped ? a : b;
    x = from.x();
    y = from.y();
    dx = swapped ? from.x() - to.x() : to.x() - from.x();
    dy = swapped ? from.y() - to.y() : to.y() - from.y();
  }
  void turn() { dx = -dx, dy = -dy; }
  double along(double row) const { return dx * (row - y); }
  /// Positive on the left.
  double side(double along, double column) const { return along - dy * (column - x); }
};

/// A picture whose pixel (column, row) has its centre there.
struct Picture {
  int columns, rows;
  std::vector<char> pixels;

  Picture(int columns_, int rows_)
      : columns(columns_), rows(rows_), pixels(static_cast<std::size_t>(columns_) * rows_, 0) {}

  /// Sets the bit in every pixel whose centre is within a triangle or on its border.
  void draw(const Projected& x, const Triangles& triangles, char bit) {
    for (Eigen::Index t = 0; t < triangles.rows(); ++t)
      draw(x.row(triangles(t, 0)), x.row(triangles(t, 1)), x.row(triangles(t, 2)), bit);
  }

 private:
  void draw(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, char bit) {
    const Eigen::Vector2d lower = a.cwiseMin(b).cwiseMin(c), upper = a.cwiseMax(b).cwiseMax(c);
    const int left = std::max(0, static_cast<int>(std::ceil(lower.x())));
    const int right = std::min(columns - 1, static_cast<int>(std::floor(upper.x())));
    const int bottom = std::max(0, static_cast<int>(std::ceil(lower.y())));
    const int top = std::min(rows - 1, static_cast<int>(std::floor(upper.y())));
    if (left > right || bottom > top) return;
    Line lines[3] = {{a, b}, {b, c}, {c, a}};
    const double area = lines[0].side(lines[0].along(c.y()), c.x());
    if (area == 0) return;  // collapsed to a line, which covers nothing
    if (area < 0)
      for (Line& line : lines) line.turn();
    for (int row = bottom; row <= top; ++row) draw_row(lines, row, left, right, bit);
  }

  /// From the first to the last pixel of a row that are on the left of all three lines.
  void draw_row(const Line (&lines)[3], int row, int first, int last, char bit) {
    constexpr int wide = 8;  // more pixels than it takes to look at each
    double along[3];
    for (int k = 0; k < 3; ++k) along[k] = lines[k].along(row);
    if (last - first > wide)
      for (int k = 0; k < 3; ++k) {
        // Where the row crosses the line, but for rounding, which is far less than a pixel.
        const double crossing = std::clamp(lines[k].x + along[k] / lines[k].dy, -1.0, double(columns));
        if (lines[k].dy > 0) last = std::min(last, static_cast<int>(crossing) + 1);
        if (lines[k].dy < 0) first = std::max(first, static_cast<int>(crossing) - 1);
      }
    const auto is_covered = [&](int column) {
      double least = lines[0].side(along[0], column);
      for (int k = 1; k < 3; ++k) least = std::min(least, lines[k].side(along[k], column));
      return least >= 0;
    };
    while (first <= last && !is_covered(first)) ++first;
    while (first <= last && !is_covered(last)) --last;
    char* pixel = &pixels[static_cast<std::size_t>(row) * columns];
    for (int column = first; column <= last; ++column) pixel[column] = static_cast<char>(pixel[column] | bit);
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

/// How far the outlines of two states cover each other: silhouette_overlap, the mean over fixed views, and
/// silhouette_lowest, that of the worst view [1].
class Silhouette : public Metric {
 public:
  int resolution = 256;

  static void declare(Declaration<Silhouette>& d) {
    d.add("resolution", &Silhouette::resolution, "pixels along the diagonal of the rest shape")
        .between(16, 4096);
  }

  MetricScope scope() const override { return MetricScope::pair; }
  MetricDeclaration declaration() const override {
    return {.columns = {{.name = "silhouette_overlap",
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

  /// The directions of view, as unit vectors: the twelve axes through the vertices of a rhombicuboctahedron.
  static std::array<Eigen::Vector3d, 12> directions() {
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

 private:
  MetricResult measure(const MetricInput& input) const override {
    const Positions& x = input.x;
    const Positions& other = *input.other;
    const double diagonal = bounding_box_diagonal(input.level.rest.vertices);
    const auto views = directions();
    std::array<double, views.size()> values;
    parallel_for(static_cast<int>(views.size()), 1, [&](int begin, int end) {
      for (int k = begin; k < end; ++k)
        values[k] = overlap(x, other, input.level.rest.triangles, views[k], diagonal / resolution);
    });
    double sum = 0;
    for (const double v : values) sum += v;
    return {{{"silhouette_overlap", sum / values.size()}, {"silhouette_lowest", std::ranges::min(values)}},
            {}};
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Metric, drape::Silhouette>(
      "silhouette", "How far the outlines of two states cover each other, from twelve sides.");
}
