#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

namespace drape {

/// The look of a solver's methods in every chart, of Python too: an index of the colours --solver-N in
/// page.css and of the marks in charts.js. Solvers that drape does not come with share the last one.
int solver_style(std::string_view solver);

/// n×3 vertex colours: red, green, blue in [0, 1], sRGB.
using Colours = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// The quantile of all finite |values|; 0 without any.
double magnitude_quantile(const std::vector<const Eigen::VectorXd*>& fields, double quantile);

/// Blue at -scale and below, white at 0, red at +scale and above; grey where not finite.
Colours diverging_colours(const Eigen::VectorXd& values, double scale);

/// Cloth grey where |values| is below the threshold, red above +threshold, blue below -threshold.
Colours fold_colours(const Eigen::VectorXd& values, double threshold);

}  // namespace drape
