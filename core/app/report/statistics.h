#pragma once

#include <optional>
#include <utility>
#include <vector>

namespace drape {

/// Median and extremes of some repeats.
struct Spread {
  double median = 0, low = 0, high = 0;
  int count = 0;
};

/// Median and extremes of values in any order; the median of an even number is the mean of the middle two.
/// Empty without values.
std::optional<Spread> spread_of(std::vector<double> values);

/// A point of a plot of error against cost.
struct CostPoint {
  double cost = 0, error = 0;
};

/// Indices of the Pareto-optimal points, ascending in cost; of equal points the first one.
std::vector<std::size_t> pareto_front(const std::vector<CostPoint>& points);

/// A curve's repeats at one cost.
struct CurvePoint {
  double cost = 0;
  Spread error;
};

/// Median and extremes over repeats of a curve of error over cost, at `count` costs in geometric progression
/// from the cost at which all have a state to the largest one. A curve's points ascend in cost; it is a step
/// function. Points with an error or cost that is not positive are skipped, as on logarithmic axes.
std::vector<CurvePoint> median_curve(const std::vector<std::vector<CostPoint>>& repeats, int count);

}  // namespace drape
