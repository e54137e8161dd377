#pragma once

#include <chrono>
#include <map>
#include <string>

namespace drape {

/// Seconds since it was made, on a clock that never runs backwards.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Adds the time of a scope to a named sum.
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
