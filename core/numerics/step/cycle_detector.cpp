#include "core/numerics/step/cycle_detector.h"

#include <algorithm>
#include <cmath>

namespace drape {

namespace {

/// Steps that must return in a row. They are more than IdleSteps waits for: round-off may cycle, too.
constexpr int needed_returns = 12;
/// A value has returned if it differs from the earlier one by this fraction of what it varies by in between.
/// Slower convergence than that, of 2 % a period, counts as none; steady descent never returns.
constexpr double returned_fraction = 0.02;

using Ring = std::array<double, CycleDetector::longest_period + 1>;

/// The range of the values from step k - period to step k.
double range(const Ring& values, int k, int period) {
  const int size = static_cast<int>(values.size());
  double low = values[k % size], high = low;
  for (int back = 1; back <= period; ++back) {
    low = std::min(low, values[(k - back) % size]);
    high = std::max(high, values[(k - back) % size]);
  }
  return high - low;
}

/// Whether the value at step k is that of `period` steps before, relative to that range.
bool returned(const Ring& values, int k, int period) {
  const int size = static_cast<int>(values.size());
  return std::abs(values[k % size] - values[(k - period) % size]) <=
         returned_fraction * range(values, k, period);
}

}  // namespace

void CycleDetector::note(double energy, double residual) {
  const int k = steps++, size = static_cast<int>(energies.size());
  energies[k % size] = energy;
  residuals[k % size] = residual;
  for (int period = shortest_period; period <= longest_period; ++period) {
    int& count = returns[period - shortest_period];
    const bool again = k >= period && range(residuals, k, period) > 0 && returned(energies, k, period) &&
                       returned(residuals, k, period);
    count = again ? count + 1 : 0;
  }
}

bool CycleDetector::cycling() const { return *std::ranges::max_element(returns) >= needed_returns; }

}  // namespace drape
