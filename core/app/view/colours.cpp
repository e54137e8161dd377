#include "core/app/view/colours.h"

#include <algorithm>
#include <cmath>

namespace drape {

namespace {

using Colour = Eigen::RowVector3f;

const Colour undefined(0.55f, 0.55f, 0.55f);

/// ColorBrewer's RdBu, reversed: readable with the common colour-vision deficiencies.
Colour diverging_colour(double t) {
  static const float table[9][3] = {
      {0.020f, 0.188f, 0.380f}, {0.129f, 0.400f, 0.675f}, {0.263f, 0.576f, 0.765f},
      {0.573f, 0.773f, 0.871f}, {0.968f, 0.968f, 0.968f}, {0.957f, 0.647f, 0.510f},
      {0.839f, 0.376f, 0.302f}, {0.698f, 0.094f, 0.169f}, {0.404f, 0.000f, 0.122f}};
  const double place = std::clamp(t * 0.5 + 0.5, 0.0, 1.0) * 8;
  const int cell = std::min(static_cast<int>(place), 7);
  const float share = static_cast<float>(place - cell);
  return Eigen::Map<const Colour>(table[cell]) * (1 - share) +
         Eigen::Map<const Colour>(table[cell + 1]) * share;
}

constexpr std::string_view styled_solvers[] = {"pcs", "cascadic", "newton"};

}  // namespace

int solver_style(std::string_view solver) {
  return static_cast<int>(std::find(std::begin(styled_solvers), std::end(styled_solvers), solver) -
                          std::begin(styled_solvers));
}

double magnitude_quantile(const std::vector<const Eigen::VectorXd*>& fields, double quantile) {
  std::vector<double> all;
  for (const Eigen::VectorXd* field : fields) {
    for (const double value : *field) {
      if (std::isfinite(value)) all.push_back(std::abs(value));
    }
  }
  if (all.empty()) return 0;
  const auto place = all.begin() + static_cast<std::ptrdiff_t>(quantile * (all.size() - 1));
  std::nth_element(all.begin(), place, all.end());
  return *place;
}

Colours diverging_colours(const Eigen::VectorXd& values, double scale) {
  Colours colours(values.size(), 3);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    colours.row(i) = !std::isfinite(values[i]) ? undefined
                     : scale > 0               ? diverging_colour(values[i] / scale)
                                               : diverging_colour(0);
  }
  return colours;
}

Colours fold_colours(const Eigen::VectorXd& values, double threshold) {
  const Colour cloth(0.80f, 0.78f, 0.75f), towards(0.78f, 0.24f, 0.16f), away(0.13f, 0.40f, 0.67f);
  Colours colours(values.size(), 3);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      colours.row(i) = undefined;
      continue;
    }
    // A narrow ramp instead of a step, so that the border of a fold does not show the triangles.
    const double ramp = std::clamp((std::abs(values[i]) / std::max(threshold, 1e-300) - 0.9) / 0.2, 0.0, 1.0);
    const float share = static_cast<float>(ramp * ramp * (3 - 2 * ramp));
    colours.row(i) = cloth * (1 - share) + (values[i] > 0 ? towards : away) * share;
  }
  return colours;
}

}  // namespace drape
