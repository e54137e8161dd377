#include "plugins/metric/distance/distance.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/numerics/parallel.h"
#include "core/plugin/plugin.h"
#include "plugins/metric/distance/closest_point.h"

namespace drape {
namespace {

/// Per vertex of `from`, squared distance to the surface of `to`, never more than the vertex's own bound.
Eigen::VectorXd squared_surface_distances(const Positions& from, const Positions& to,
                                          const Triangles& triangles, const Eigen::VectorXd& bounds) {
  const SurfaceDistance surface(to, triangles);
  Eigen::VectorXd result(from.rows());
  parallel_for(static_cast<int>(from.rows()), 256, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) result[i] = surface.squared(from.row(i).transpose(), bounds[i]);
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

  // The corresponding vertex lies on the other surface, so its distance bounds the distance to it.
  const Eigen::VectorXd squared = (x - other).rowwise().squaredNorm();
  const Triangles& triangles = input.level.rest.triangles;
  const double there = squared_surface_distances(x, other, triangles, squared).maxCoeff();
  const double back = squared_surface_distances(other, x, triangles, squared).maxCoeff();
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
