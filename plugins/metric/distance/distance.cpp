#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/kernel/interfaces/metric.h"
#include "core/kernel/plugin/plugin.h"
#include "core/kernel/threads/parallel.h"
#include "core/numerics/collision_detection/closest.h"

namespace drape {
namespace {

using Geometry = CGAL::Simple_cartesian<double>;
using Point = Geometry::Point_3;
using Corners = std::vector<Geometry::Triangle_3>;

Point point(const Positions& x, Eigen::Index i) { return {x(i, 0), x(i, 1), x(i, 2)}; }
Eigen::Vector3d vector(const Point& p) { return {p.x(), p.y(), p.z()}; }

using Plain = CGAL::AABB_traits<Geometry, CGAL::AABB_triangle_primitive<Geometry, Corners::const_iterator>>;

/// CGAL's, but for triangles that have collapsed to a line, whose nearest point CGAL may miss.
struct Traits : Plain {
  struct Nearest {
    Plain::Closest_point of_others;

    /// The triangle's nearest point to p, or `bound` if that is as near.
    Point operator()(const Point& p, const Primitive& primitive, const Point& bound) const {
      const Geometry::Triangle_3& t = *primitive.id();
      const Eigen::Vector3d a = vector(t[0]), b = vector(t[1]), c = vector(t[2]);
      constexpr double squared_sine = 1e-16;
      if ((b - a).cross(c - a).squaredNorm() > squared_sine * (b - a).squaredNorm() * (c - a).squaredNorm())
        return of_others(p, primitive, bound);
      const Closest weights = closest_point_triangle(vector(p), a, b, c);
      const Eigen::Vector3d n = -(weights.c[1] * a + weights.c[2] * b + weights.c[3] * c);
      const Point nearest(n[0], n[1], n[2]);
      return CGAL::squared_distance(p, nearest) < CGAL::squared_distance(p, bound) ? nearest : bound;
    }
  };
  Nearest closest_point_object() const { return {Plain::closest_point_object()}; }
};

/// The largest squared distance of a vertex of `from` to the surface of `to`. The vertex of the same number
/// bounds each; those with the largest bounds come first, until no bound exceeds a distance that was found.
double largest_squared_distance(const Positions& from, const Positions& to, const Triangles& triangles) {
  const Eigen::VectorXd bounds = (from - to).rowwise().squaredNorm();
  std::vector<int> order(from.rows());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) { return bounds[i] > bounds[j]; });

  Corners corners;
  corners.reserve(triangles.rows());
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    corners.emplace_back(point(to, triangles(t, 0)), point(to, triangles(t, 1)), point(to, triangles(t, 2)));
  CGAL::AABB_tree<Traits> surface(corners.begin(), corners.end());
  surface.build();  // else the first of the threads would
  constexpr int at_once = 256;
  double largest = 0;
  std::array<double, at_once> found;
  for (std::size_t first = 0; first < order.size() && bounds[order[first]] > largest; first += at_once) {
    const int count = static_cast<int>(std::min<std::size_t>(at_once, order.size() - first));
    parallel_for(count, 16, [&](int begin, int end) {
      for (int k = begin; k < end; ++k) {
        const int i = order[first + k];
        const Point p = point(from, i);
        found[k] = CGAL::squared_distance(p, surface.closest_point(p, point(to, i)));
      }
    });
    largest = std::max(largest, *std::max_element(found.begin(), found.begin() + count));
  }
  return largest;
}

}  // namespace

/// Distances between two states, in units of the rest shape's bounding-box diagonal: distance_rms,
/// distance_max over corresponding vertices, distance_hausdorff between the surfaces.
class Distance : public Metric {
 public:
  MetricScope scope() const override { return MetricScope::pair; }
  MetricDeclaration declaration() const override {
    return {.columns = {{.name = "distance_rms",
                         .label = "distance, RMS",
                         .unit = "diagonal",
                         .error = "rms",
                         .error_use = ErrorUse::ranking},
                        {.name = "distance_max",
                         .label = "distance, largest",
                         .unit = "diagonal",
                         .shown = Shown::stored},
                        {.name = "distance_hausdorff",
                         .label = "Hausdorff distance",
                         .unit = "diagonal",
                         .shown = Shown::stored,
                         .error = "hausdorff"}},
            .text = "The distance is that of corresponding points, in units of the rest shape's diagonal."};
  }

 private:
  MetricResult measure(const MetricInput& input) const override {
    const Positions& x = input.x;
    const Positions& other = *input.other;
    const double diagonal = bounding_box_diagonal(input.level.rest.vertices);

    const Eigen::VectorXd squared = (x - other).rowwise().squaredNorm();
    const Triangles& triangles = input.level.rest.triangles;
    const double there = largest_squared_distance(x, other, triangles);
    const double back = largest_squared_distance(other, x, triangles);
    const Eigen::VectorXd& area = input.level.vertex_area;

    MetricResult result;
    const auto add = [&](const char* name, double squared_distance) {
      result.values.push_back({name, std::sqrt(squared_distance) / diagonal});
    };
    add("distance_rms", area.dot(squared) / area.sum());
    add("distance_max", squared.maxCoeff());
    add("distance_hausdorff", std::min(std::max(there, back), squared.maxCoeff()));  // but for rounding it is
    return result;
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Metric, drape::Distance>(
      "distance", "Distance between two states in units of the rest shape's diagonal.");
}
