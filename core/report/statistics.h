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

/// Of the values, in any order; of an even number, the median is the mean of the middle two. Nothing of none.
std::optional<Spread> spread_of(std::vector<double> values);

/// A point of a plot of error against cost.
struct CostPoint {
  double cost = 0, error = 0;
};

/// Which points no other one beats, that is none that costs no more and errs no more, and less in one of
/// both; ascending in cost. Of equal points the first one.
std::vector<std::size_t> pareto_front(const std::vector<CostPoint>& points);

/// A curve's repeats at one cost.
struct CurvePoint {
  double cost = 0;
  Spread error;
};

/// Repeats of a curve of the error a state has once so much has been spent: median and extremes on `count`
/// costs in equal ratios, from where all have a state to where the last one ends. A curve's points ascend in
/// cost; between two, the state is that of the first, and after the last one its. Errors that are not
/// positive, and costs, are left out, as logarithmic axes do.
std::vector<CurvePoint> median_curve(const std::vector<std::vector<CostPoint>>& repeats, int count);

}  // namespace drape
