#pragma once

#include <ctime>

#include "tests/support/time_limit.h"

/// The processor time that this process takes from here on, divided by the slowdown that the tests run with:
/// neither a busy machine nor a sanitizer makes it longer.
class ProcessorTime {
 public:
  double seconds() const {
    return static_cast<double>(std::clock() - begun_) / CLOCKS_PER_SEC / test_slowdown();
  }

 private:
  std::clock_t begun_ = std::clock();
};
