#pragma once

#include <chrono>
#include <map>
#include <string>

namespace drape {

/// Seconds since construction on a monotonic clock, plus an initial value.
class Stopwatch {
 public:
  explicit Stopwatch(double already = 0) : already_(already) {}
  double seconds() const { return already_ + std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  double already_;
  Clock::time_point start_ = Clock::now();
};

/// Adds the duration of its scope to a named sum [s].
class PhaseTimer {
 public:
  PhaseTimer(std::map<std::string, double>& sums, const char* phase) : sum_(sums[phase]) {}
  ~PhaseTimer() { sum_ += watch_.seconds(); }
  PhaseTimer(const PhaseTimer&) = delete;
  PhaseTimer& operator=(const PhaseTimer&) = delete;

 private:
  double& sum_;
  Stopwatch watch_;
};

}  // namespace drape
