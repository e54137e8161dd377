#include "core/app/run/time_to_go.h"

#include <algorithm>
#include <cmath>

namespace drape {

namespace {

/// No estimate before this many notes with progress and this fraction.
constexpr int min_notes = 8;
constexpr double min_done = 0.02;
/// Estimates above this many times the elapsed time are not shown.
constexpr double max_ratio = 50;
/// Time constant of the smoothing [s].
constexpr double smoothing = 5;

}  // namespace

void TimeToGo::note(double seconds, double done) {
  const double passed = seconds - now_;
  now_ = seconds;
  done = std::clamp(done, 0.0, 1.0);
  if (track_.empty() || done > track_.back().second) track_.emplace_back(seconds, done);
  const std::optional<double> estimate = extrapolated();
  known_ = estimate.has_value();
  if (!known_) return;
  if (shown_ == 0) {
    shown_ = *estimate;
    return;
  }
  const double expected = std::max(shown_ - passed, shown_ / 2), weight = 1 - std::exp(-passed / smoothing);
  shown_ = std::clamp(expected * std::pow(*estimate / expected, weight), shown_ / 2, shown_ * 2);
}

std::optional<double> TimeToGo::extrapolated() const {
  if (static_cast<int>(track_.size()) < min_notes || track_.back().second < min_done) return {};
  const double begun = track_.front().first, half = (begun + now_) / 2;
  const auto later = std::ranges::upper_bound(track_, half, {}, &std::pair<double, double>::first);
  const auto& [middle, done] = *std::prev(later);
  const double rate = (track_.back().second - done) / (now_ - middle);
  const double estimate = (1 - track_.back().second) / rate;
  if (!(rate > 0) || !(estimate <= max_ratio * (now_ - begun))) return {};
  return std::max(estimate, 1e-3);  // positive, for its logarithm
}

}  // namespace drape
