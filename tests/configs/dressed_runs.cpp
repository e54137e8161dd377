// Garments that are dressed: killed in each phase, on any number of threads, and refused in a sentence.

#include "core/app/report/run_data.h"
#include "tests/configs/resuming.h"
#include "tests/support/any_threads.h"
#include "tests/support/refusal.h"
#include "tests/support/solve.h"
#include "tests/support/tube_dress.h"

using namespace drape;

namespace {

/// A tube that would fall, held by the top of its front.
const std::string held =
    "pins: [{region: box, lower: [-1, -1, 0.099], upper: [1, -0.01, 1]}]\n"
    "material: {density: 300, thickness: 5e-4, membrane_modulus: 4e5, bending_modulus: 1e5}\n"
    "energies: [neo_hookean, hinge, gravity]\n";

constexpr const char* cloth =
    "material: {density: 300, thickness: 5e-4, membrane_modulus: 4e5, bending_modulus: 1e5}\n"
    "energies: [neo_hookean, hinge, gravity]\n";

TubeDress small_tube() { return {.columns = 8, .rows = 5, .facets = 24}; }

std::string refused(const TubeDress& tube, const std::string& more = cloth) {
  const Scratch folder;
  tube.write(folder, more);
  return refusal_of([&] { scene_of(experiment_in(folder / "e.yaml")); });
}

}  // namespace

TEST_CASE("A dressing that is killed in each phase resumes to the same bits") {
  const Scratch folder;
  small_tube().write(folder, held);
  const Experiment experiment = experiment_in(folder / "e.yaml");
  run_experiment(experiment, *scene_of(experiment), silent(folder / "whole"));
  std::map<std::string, int> steps;  // at the end of each phase
  int all = 0;
  const Json whole = read_results(folder / "whole");
  for (const auto& row : whole["methods"]["newton"]["increments"]) {
    all += row["steps"].get<int>();
    if (row.contains("phase")) steps[row["phase"]] = all;
  }
  for (const std::string phase : {"growth", "sewing", "weight"}) {
    INFO(phase);
    REQUIRE(steps.contains(phase));
    RunOptions options = silent(folder / phase);
    options.checkpoint = 0;
    int polled = 0;
    options.stop = [&] { return ++polled > steps[phase] - 1; };  // asked at every step
    run_experiment(experiment, *scene_of(experiment), options);
    REQUIRE_FALSE(is_complete(folder / phase));
    std::vector<std::string> warnings;
    ConfigErrors errors;
    auto saved = read_saved_run(folder / phase, test_registry(), LargeMemory::allowed, warnings, errors);
    throw_errors(errors);
    REQUIRE(saved->interrupted);
    resume_experiment(saved->experiment, *saved->scene, silent(folder / phase),
                      std::move(*saved->interrupted));
    check_equal(folder / phase, folder / "whole");
  }
}

TEST_CASE("A pin holds a garment that would fall where the sewing has left it") {
  TubeDress loose = small_tube();
  loose.width = 0.4;
  const Scratch folder;
  loose.write(folder, held);
  Solved s{experiment_in(folder / "e.yaml", {{"friction", "0"}}), nullptr, {}};
  s.scene = scene_of(s.experiment);
  run_method(s);
  INFO(s.levels[0].message);
  REQUIRE(s.levels[0].outcome == Outcome::converged);
  const std::vector<DirichletVertex>& pinned = s.model().dirichlet();
  REQUIRE(pinned.size() == 7);
  for (const DirichletVertex& d : pinned) {
    CHECK(s.x().row(d.vertex) == d.target.transpose());
    CHECK(std::abs(d.target.z() - 0.1) < 0.02);
    CHECK(std::hypot(d.target.x(), d.target.y()) > loose.radius);
    CHECK(std::abs(d.target.y()) < 0.7 * loose.apart);  // not where it was placed
  }
}

TEST_CASE("A dressing has the same bits on any number of threads") {
  const Scratch folder;
  small_tube().write(folder, cloth);
  same_with_any_threads([&] {
    Solved s{experiment_in(folder / "e.yaml"), nullptr, {}};
    s.scene = scene_of(s.experiment);
    run_method(s);
    CHECK(has_converged(s.levels[0].outcome));
    return s.x();
  });
}

TEST_CASE("What cannot be dressed is refused in a sentence") {
  TubeDress elsewhere = small_tube();
  elsewhere.at = {3, 0, 0};
  CHECK(
      refused(elsewhere).ends_with("the garment is nowhere near its body: it is 0.28 × 0.4 × 0.2 m, and the "
                                   "body 0.2 × 0.2 × 0.6 m; are the "
                                   "unit, the axis and the place of both right?"));
  TubeDress giant = small_tube();
  giant.radius = 5, giant.body_height = 30, giant.at = {1, 0, 0};
  CHECK_THAT(refused(giant), Catch::Contains("the garment is inside its body: it is 0.28 × 0.4 × 0.2 m"));
  const TubeDress beside{.at = {0, -0.2, 0}};  // the front passes through the axis
  CHECK_THAT(refused(beside),
             Catch::Matches(".*no start is free of intersections: of all that were tried, the best "
                            "still has [0-9]+ pairs, most of piece front: .*place the pieces around "
                            "the body, not through it"));
  CHECK_THAT(refused(small_tube(), "energies: [neo_hookean, {type: strain_limit, limit: 1.2}, gravity]\n"),
             Catch::Contains(
                 "\"dress\" stretches the cloth on the way beyond what strain_limit allows; leave it out"));
  CHECK_THAT(
      refused(small_tube(), std::string(cloth) +
                                "schedule: {keys: [{parameter: friction, times: [0, 1], values: [0, 1]}]}\n"),
      Catch::Contains("\"dress\" makes the schedule itself"));
}
