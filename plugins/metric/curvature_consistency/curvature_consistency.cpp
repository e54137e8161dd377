#include "plugins/metric/curvature_consistency/curvature_consistency.h"

#include <stdexcept>
#include <string>

#include "core/kernel/plugin/plugin.h"
#include "plugins/metric/curvature_consistency/curvature.h"

namespace drape {

void CurvatureConsistency::Parameters::declare(Declaration<Parameters>& d) {
  d.add("rings", &Parameters::rings)
      .at_least(1)
      .at_most(50)
      .description("how many edges away from a vertex the quadric fit of its curvature reaches")
      .source("Panozzo et al. 2010; libigl's default is 5");
}

MetricResult CurvatureConsistency::evaluate(const MetricInput& input) const {
  if (!input.other)
    throw std::runtime_error("curvature_consistency compares two states of one level, but was given one");
  if (input.x.rows() != input.level.vertex_count() || input.other->rows() != input.level.vertex_count())
    throw std::runtime_error("curvature_consistency: both states must have the level's " +
                             std::to_string(input.level.vertex_count()) + " vertices, not " +
                             std::to_string(input.x.rows()) + " and " + std::to_string(input.other->rows()));
  const Triangles& triangles = input.level.rest.triangles;
  const Topology& topology = input.level.topology;
  const VertexCurvatures fit = fit_curvatures(input.x, triangles, topology, parameters_.rings);
  const VertexCurvatures other_fit = fit_curvatures(*input.other, triangles, topology, parameters_.rings);
  const VertexCurvatures ddg = ddg_curvatures(input.x, triangles, topology);
  const VertexCurvatures other_ddg = ddg_curvatures(*input.other, triangles, topology);

  const auto integral = [&](const Eigen::VectorXd& coarse, const Eigen::VectorXd& fine) {
    return integrated_square_difference(input.level.vertex_area, coarse, fine);
  };
  MetricResult result;
  result.values = {{"d_H_fit", integral(other_fit.mean, fit.mean), "1", Better::lower},
                   {"d_H_ddg", integral(other_ddg.mean, ddg.mean), "1", Better::lower},
                   {"d_K_fit", integral(other_fit.gaussian, fit.gaussian), "1/m²", Better::lower},
                   {"d_K_ddg", integral(other_ddg.gaussian, ddg.gaussian), "1/m²", Better::lower}};
  result.fields = {{"H_difference", other_fit.mean - fit.mean, "1/m"},
                   {"principal_curvature", strongest_curvature(fit), "1/m"},
                   {"principal_curvature_other", strongest_curvature(other_fit), "1/m"}};
  return result;
}

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Metric, drape::CurvatureConsistency>(
      "curvature_consistency",
      "Integrated squared difference of mean and Gaussian curvature between two states.");
}
