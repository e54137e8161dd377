#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/report/render.h"

namespace drape {

/// The value below which the share `quantile` of all finite |values| lie; 0 if there are none.
double magnitude_quantile(const std::vector<const Eigen::VectorXd*>& fields, double quantile);

/// Blue at -scale and below, white at 0, red at +scale and above; grey where not finite.
Colours diverging_colours(const Eigen::VectorXd& values, double scale);

/// Cloth grey where |values| is below the threshold, red above +threshold, blue below -threshold.
Colours fold_colours(const Eigen::VectorXd& values, double threshold);

}  // namespace drape
