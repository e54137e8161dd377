#include "plugins/metric/distance/distance.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/numerics/parallel.h"
#include "core/plugin/plugin.h"

namespace drape {
namespace {

using Geometry = CGAL::Simple_cartesian<double>;
using Corners = std::vector<Geometry::Triangle_3>;
using Tree = CGAL::AABB_tree<
    CGAL::AABB_traits<Geometry, CGAL::AABB_triangle_primitive<Geometry, Corners::const_iterator>>>;

Geometry::Point_3 point(const Positions& x, Eigen::Index i) { return {x(i, 0), x(i, 1), x(i, 2)}; }

/// Per vertex of `from`, squared distance to the surface of `to`. The search begins at the nearer of two
/// points of that surface: the vertex of the same number, and what was nearest to the vertex before.
Eigen::VectorXd squared_surface_distances(const Positions& from, const Positions& to,
                                          const Triangles& triangles) {
  Corners corners;
  corners.reserve(triangles.rows());
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    corners.emplace_back(point(to, triangles(t, 0)), point(to, triangles(t, 1)), point(to, triangles(t, 2)));
  Tree surface(corners.begin(), corners.end());
  surface.do_not_accelerate_distance_queries();
  surface.build();
  Eigen::VectorXd result(from.rows());
  parallel_for(static_cast<int>(from.rows()), 256, [&](int begin, int end) {
    Geometry::Point_3 nearest = point(to, begin);
    for (int i = begin; i < end; ++i) {
      const Geometry::Point_3 p = point(from, i), same = point(to, i);
      const bool is_nearer = CGAL::squared_distance(p, nearest) < CGAL::squared_distance(p, same);
      nearest = surface.closest_point(p, is_nearer ? nearest : same);
      result[i] = CGAL::squared_distance(p, nearest);
    }
  });
  return result;
}

}  // namespace

MetricResult Distance::evaluate(const MetricInput& input) const {
  if (!input.other) throw std::runtime_error("distance compares two states of one level, but was given one");
  const Positions& x = input.x;
  const Positions& other = *input.other;
  if (x.rows() != input.level.vertex_count() || other.rows() != input.level.vertex_count())
    throw std::runtime_error("distance: both states must have the level's " +
                             std::to_string(input.level.vertex_count()) + " vertices, not " +
                             std::to_string(x.rows()) + " and " + std::to_string(other.rows()));
  if (!x.allFinite() || !other.allFinite())
    throw std::runtime_error("distance: a state has positions that are not finite");
  const Positions& rest = input.level.rest.vertices;
  const double diagonal = (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm();

  const Eigen::VectorXd squared = (x - other).rowwise().squaredNorm();
  const Triangles& triangles = input.level.rest.triangles;
  const double there = squared_surface_distances(x, other, triangles).maxCoeff();
  const double back = squared_surface_distances(other, x, triangles).maxCoeff();
  const Eigen::VectorXd& area = input.level.vertex_area;

  MetricResult result;
  const auto add = [&](const char* name, double squared_distance) {
    result.values.push_back({name, std::sqrt(squared_distance) / diagonal, "diagonal", Better::lower});
  };
  add("distance_rms", area.dot(squared) / area.sum());
  add("distance_max", squared.maxCoeff());
  add("distance_hausdorff", std::max(there, back));
  return result;
}

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Metric, drape::Distance>(
      "distance", "Distance between two states in units of the rest shape's diagonal.");
}
