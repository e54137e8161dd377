#pragma once

#include <optional>
#include <utility>
#include <vector>

namespace drape {

/// How long something still takes, from how much of it has been done when. What it says changes smoothly:
/// from one note to the next by no more than a factor of two, and by a factor of ten only over seconds.
class TimeToGo {
 public:
  /// At `seconds`, which rise, `done` of the whole has been done, in [0, 1]; less than before counts as
  /// nothing new.
  void note(double seconds, double done);
  /// After the last note [s]; none while it is unknown: at first, and where nothing has been done for long.
  std::optional<double> seconds() const { return known_ ? std::optional(shown_) : std::nullopt; }

 private:
  /// At the rate of the later half of the time so far.
  std::optional<double> extrapolated() const;

  std::vector<std::pair<double, double>> track_;  // seconds, done; where that rose
  double now_ = 0, shown_ = 0;                    // shown_ is 0 before it was known for the first time
  bool known_ = false;
};

}  // namespace drape
