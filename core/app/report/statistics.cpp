#include "core/app/report/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace drape {

std::optional<Spread> spread_of(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return Spread{(values[(n - 1) / 2] + values[n / 2]) / 2, values.front(), values.back(),
                static_cast<int>(n)};
}

std::vector<std::size_t> pareto_front(const std::vector<CostPoint>& points) {
  std::vector<std::size_t> order(points.size()), front;
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const CostPoint &p = points[a], &q = points[b];
    return p.cost != q.cost ? p.cost < q.cost : p.error < q.error;
  });
  for (std::size_t k : order)
    if (front.empty() || points[k].error < points[front.back()].error) front.push_back(k);
  return front;
}

std::vector<CurvePoint> median_curve(const std::vector<std::vector<CostPoint>>& repeats, int count) {
  double begin = 0, end = 0;
  std::vector<std::vector<CostPoint>> curves;
  for (const auto& repeat : repeats) {
    std::vector<CostPoint> curve;
    for (const CostPoint& p : repeat)
      if (p.cost > 0 && p.error > 0) curve.push_back(p);
    if (curve.empty()) continue;
    begin = std::max(begin, curve.front().cost);
    end = std::max(end, curve.back().cost);
    curves.push_back(std::move(curve));
  }
  std::vector<CurvePoint> points;
  if (curves.empty()) return points;
  for (int k = 0; k < count; ++k) {
    const double part = count > 1 ? double(k) / (count - 1) : 1;
    // Not by a power alone: round-off may miss the ends.
    const double cost = k == 0 ? begin : k + 1 == count ? end : begin * std::pow(end / begin, part);
    std::vector<double> errors;
    for (const auto& curve : curves) {
      const auto after = std::upper_bound(curve.begin(), curve.end(), cost,
                                          [](double c, const CostPoint& p) { return c < p.cost; });
      if (after != curve.begin()) errors.push_back(std::prev(after)->error);
    }
    points.push_back({cost, *spread_of(errors)});
    if (begin == end) break;
  }
  return points;
}

}  // namespace drape
