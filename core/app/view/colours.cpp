#include "core/app/view/colours.h"

#include <algorithm>
#include <cmath>

namespace drape {

namespace {

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

}  // namespace drape
