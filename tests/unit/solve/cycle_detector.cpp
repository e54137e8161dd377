#include "core/numerics/step/cycle_detector.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

using namespace drape;

namespace {

/// The first step after which the detector reports a cycle, -1 for none in 200.
int detected(const std::function<double(int)>& energy, const std::function<double(int)>& residual) {
  CycleDetector detector;
  for (int k = 0; k < 200; ++k) {
    detector.note(energy(k), residual(k));
    if (detector.cycling()) return k;
  }
  return -1;
}

int detected(const std::function<double(int)>& both) { return detected(both, both); }

}  // namespace

TEST_CASE("States that repeat every two, three or four steps are a cycle after twelve returns") {
  for (const int period : {2, 3, 4})
    CHECK(detected([&](int k) { return 1 + 1e-6 * (k % period); }) == period + 11);
  CHECK(detected([](int k) { return 1 + 1e-6 * (k % 5); }) == -1);
  // The first steps differ; so does the limit cycle, until it is nearly reached.
  CHECK(detected([](int k) { return std::exp(-0.5 * k) + (k % 2 ? 1 : -1); }) > 13);
}

TEST_CASE("What converges, however slowly, or stands still is no cycle") {
  CHECK(detected([](int k) { return std::exp(-1e-4 * k); }) == -1);
  CHECK(detected([](int k) { return 1 + std::pow(-0.95, k); }) == -1);
  CHECK(detected([](int) { return 1.0; }) == -1);
  CHECK(detected([](int k) { return -1e-9 * k; }, [](int k) { return 1.0 + k % 2; }) == -1);  // descends
  CHECK(detected([](int) { return std::nan(""); }) == -1);
}
