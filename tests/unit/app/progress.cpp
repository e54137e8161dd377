#include "core/app/run/progress.h"

#include <catch2/catch.hpp>
#include <limits>

using namespace drape;

namespace {

/// Forty increments, `at` of which is under way.
struct Forty : LoadStepping {
  int at = 0;
  bool equilibrates_each = true;
  int increment_count() const override { return 40; }
  bool equilibrates() const override { return equilibrates_each; }
  void begin(int, bool) override {}
  LoadSteppingState state() const override { return {at, {}}; }
  void restore(int, const LoadSteppingState&) override {}
  std::shared_ptr<const LevelModel> model(int) override { return nullptr; }
  int increment() const override { return at; }
  bool complete() const override { return true; }
  double time() const override { return at; }
  StepLimit advance(int, const Positions&) override { return {}; }
  bool advance_by(double, int, const Positions&) override { return false; }
};

IterationRow row_of(int step, double residual, std::optional<double> time = {}) {
  IterationRow row;
  row.level = 1;
  row.step = step;
  row.force_residual = residual;
  row.energy = -0.25;
  row.time = time;
  return row;
}

std::string line_after(Progress& progress, const IterationRow& row) {
  progress.iteration(row, Positions());
  return progress.line(row);
}

}  // namespace

TEST_CASE("The progress line shows how far a level is from its tolerance") {
  Progress progress(1e-4, 3, Verbosity::quiet);
  progress.method_started("pcs");
  progress.level_started(1);
  CHECK(line_after(progress, row_of(0, 1)) ==
        "pcs       level 1/2 ░░░░░░░░░░░░░░░░ step 0    residual 1.00e+00  energy -0.25 J");
  CHECK(line_after(progress, row_of(7, 1e-2)) ==
        "pcs       level 1/2 ████████░░░░░░░░ step 7    residual 1.00e-02  energy -0.25 J");
  // What has been reached stays, though the residual rises for a while.
  CHECK(line_after(progress, row_of(8, 10)) ==
        "pcs       level 1/2 ████████░░░░░░░░ step 8    residual 1.00e+01  energy -0.25 J");
}

TEST_CASE("A line of its own has the whole iteration, contacts and gap where there are any") {
  Progress progress(1e-4, 3, Verbosity::quiet);
  progress.method_started("pcs");
  IterationRow row = row_of(7, 1e-2);
  row.iteration = 9;
  row.decrement = 2e-3;
  row.step_size = 0.5;
  row.step_length = 1;
  const std::string plain =
      "pcs level 1/2 step 7 iteration 9  residual 1.00e-02  decrement 2.00e-03 m/s  energy -0.25 J  "
      "step size 5.00e-01 s  step length 1.00e+00";
  CHECK(progress.details(row) == plain);
  row.contacts = 3;
  row.smallest_gap = 1e-4;
  CHECK(progress.details(row) == plain + "  contacts 3  smallest gap 1.00e-04 m");
  row.contacts = 0;
  row.smallest_gap = std::numeric_limits<double>::infinity();
  CHECK(progress.details(row) == plain + "  contacts 0");
}

TEST_CASE("Under a schedule the progress line shows which increment of how many, and of what") {
  Forty increments;
  Progress progress(1e-4, 3, Verbosity::quiet, &increments, {"pins.0.translate"});
  progress.method_started("newton");
  progress.level_started(1);
  CHECK(
      line_after(progress, row_of(0, 1, 0)) ==
      "newton    level 1/2 increment 0/40 of pins.0.translate ░░░░░░░░░░░░░░░░ step 0    residual 1.00e+00  "
      "energy -0.25 J");
  increments.at = 20;  // half of an increment in the middle of 41
  line_after(progress, row_of(99, 1, 20));
  CHECK(
      line_after(progress, row_of(100, 1e-2, 20)) ==
      "newton    level 1/2 increment 20/40 of pins.0.translate ████████░░░░░░░░ step 100  residual 1.00e-02  "
      "energy -0.25 J");

  Progress of_many(1e-4, 3, Verbosity::quiet, &increments,
                   {"pins.0.translate", "material.density", "friction"});
  of_many.level_started(1);
  CHECK_THAT(line_after(of_many, row_of(0, 1, 20)),
             Catch::Contains(" increment 20/40 of pins.0.translate and 2 more "));
  // A later solve without load stepping, such as the reference.
  CHECK_THAT(line_after(of_many, row_of(0, 1)), !Catch::Contains("increment"));
}
