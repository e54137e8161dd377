#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

namespace drape {

/// The look of a solver's methods in every chart, of Python too: an index of the colours --solver-N in
/// viewer/page.css and of the marks in viewer/charts.js. Solvers that drape does not come with share the last
/// one.
int solver_style(std::string_view solver);

/// The quantile of all finite |values|; 0 without any.
double magnitude_quantile(const std::vector<const Eigen::VectorXd*>& fields, double quantile);

}  // namespace drape
