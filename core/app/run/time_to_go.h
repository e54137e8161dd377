#pragma once

#include <optional>
#include <utility>
#include <vector>

namespace drape {

/// Estimates remaining time from progress over time. The estimate changes smoothly: at most by a factor of
/// two per note, and by a factor of ten only over seconds.
class TimeToGo {
 public:
  /// Notes that the fraction `done` in [0, 1] was complete at `seconds`, which ascend. A fraction below the
  /// last one counts as no progress.
  void note(double seconds, double done);
  /// Remaining time after the last note [s]; empty at first and after a long time without progress.
  std::optional<double> seconds() const { return known_ ? std::optional(shown_) : std::nullopt; }

 private:
  /// By the rate of the second half of the time so far.
  std::optional<double> extrapolated() const;

  std::vector<std::pair<double, double>> track_;  // seconds and fraction, where it rose
  double now_ = 0, shown_ = 0;                    // shown_ is 0 before the first estimate
  bool known_ = false;
};

}  // namespace drape
