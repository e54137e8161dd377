// What follows a run: its progress line, and the snapshots that are kept.

#include <catch2/catch.hpp>
#include <limits>
#include <vector>

#include "core/app/run/errors.h"
#include "core/app/run/progress.h"
#include "tests/support/fake_loads.h"

using namespace drape;

namespace {

IterationRow row_of_step(int step, double residual, std::optional<double> time = {}) {
  IterationRow row;
  row.level = 1;
  row.step = step;
  row.force_residual = residual;
  row.energy = -0.25;
  row.time = time;
  return row;
}

/// The line after an iteration.
std::string line_after(Progress& progress, const IterationRow& row) {
  progress.iteration(row, Positions());
  return progress.line(row);
}

Positions positions_at(int iteration) { return Positions::Constant(4, 3, iteration / 3.0); }

/// The iterations that are kept of so many.
std::vector<int> kept(int most, int iterations) {
  SnapshotRecorder snapshots;
  for (int k = 1; k <= iterations; ++k) snapshots.iteration({0.1 * k, k, 5.0 * k}, positions_at(k), most);
  std::vector<int> of;
  for (const Snapshot& snapshot :
       snapshots.end_level({0.1 * iterations, iterations, 0}, positions_at(iterations))) {
    CHECK((snapshot.x - positions_at(snapshot.cost.iterations)).norm() == 0);
    of.push_back(snapshot.cost.iterations);
  }
  return of;
}

}  // namespace

TEST_CASE("The progress line shows how far a level is from its tolerance") {
  Progress progress(1e-4, 3, Verbosity::quiet);
  progress.method_started("pcs");
  progress.level_started(1);
  CHECK(line_after(progress, row_of_step(0, 1)) ==
        "pcs       level 1/2 ░░░░░░░░░░░░░░░░ step 0    residual 1.00e+00  energy -0.25 J");
  CHECK(line_after(progress, row_of_step(7, 1e-2)) ==
        "pcs       level 1/2 ████████░░░░░░░░ step 7    residual 1.00e-02  energy -0.25 J");
  // What has been reached stays, though the residual rises for a while.
  CHECK(line_after(progress, row_of_step(8, 10)) ==
        "pcs       level 1/2 ████████░░░░░░░░ step 8    residual 1.00e+01  energy -0.25 J");
}

TEST_CASE("A line of its own has the whole iteration, contacts and gap where there are any") {
  Progress progress(1e-4, 3, Verbosity::quiet);
  progress.method_started("pcs");
  IterationRow row = row_of_step(7, 1e-2);
  row.iteration = 9, row.decrement = 2e-3, row.step_size = 0.5, row.step_length = 1;
  const std::string plain =
      "pcs level 1/2 step 7 iteration 9  residual 1.00e-02  decrement 2.00e-03 m/s  energy -0.25 J  "
      "step size 5.00e-01 s  step length 1.00e+00";
  CHECK(progress.details(row) == plain);
  row.contacts = 3, row.smallest_gap = 1e-4;
  CHECK(progress.details(row) == plain + "  contacts 3  smallest gap 1.00e-04 m");
  row.contacts = 0, row.smallest_gap = std::numeric_limits<double>::infinity();
  CHECK(progress.details(row) == plain + "  contacts 0");
}

TEST_CASE("Under a schedule the progress line shows which increment of how many, and of what") {
  FakeLoads loads;
  loads.increments = 40;
  Progress progress(1e-4, 3, Verbosity::quiet, &loads, {"pins.0.translate"});
  progress.method_started("newton");
  progress.level_started(1);
  CHECK_THAT(
      line_after(progress, row_of_step(0, 1, 0)),
      Catch::StartsWith("newton    level 1/2 increment 0/40 of pins.0.translate ░░░░░░░░░░░░░░░░ step 0 "));
  for (int k = 0; k < 20; ++k) loads.advance(1, {});
  line_after(progress, row_of_step(99, 1, 20));  // then half of an increment in the middle of 41
  CHECK(line_after(progress, row_of_step(100, 1e-2, 20)) ==
        "newton    level 1/2 increment 20/40 of pins.0.translate ████████░░░░░░░░ step 100  residual 1.00e-02"
        "  energy -0.25 J");

  Progress of_many(1e-4, 3, Verbosity::quiet, &loads, {"pins.0.translate", "material.density", "friction"});
  of_many.level_started(1);
  CHECK_THAT(line_after(of_many, row_of_step(0, 1, 20)),
             Catch::Contains(" increment 20/40 of pins.0.translate and 2 more "));
  // A later solve without load stepping, such as the reference.
  CHECK_THAT(line_after(of_many, row_of_step(0, 1)), !Catch::Contains("increment"));
}

TEST_CASE("snapshots are spread evenly, never more than asked for, the last state among them") {
  CHECK(kept(8, 7) == std::vector{1, 2, 3, 4, 5, 6, 7});
  CHECK(kept(8, 8) == std::vector{1, 3, 5, 7, 8});
  CHECK(kept(8, 100) == std::vector{1, 17, 33, 49, 65, 81, 97, 100});
  CHECK(kept(2, 9) == std::vector{1, 9});
  for (int most = 1; most < 12; ++most)
    for (int n = 0; n < 200; ++n) {
      const std::vector<int> all = kept(most, n);
      REQUIRE(static_cast<int>(all.size()) <= most);
      REQUIRE(all.back() == n);
    }
}
