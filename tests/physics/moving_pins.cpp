// Cloth that pins pull and twist through contact, with bounds on the cost of an increment.

#include <algorithm>

#include "tests/support/known_answers.h"
#include "tests/support/stepped.h"

using namespace drape;

namespace {

/// Newton iterations of increments before the last, which ends at equilibrium: the largest and the sum.
std::pair<int, int> iterations_of(const std::string& scene) {
  const Stepped s(scene);
  INFO(s.levels[0].message);
  CHECK(s.levels[0].outcome == Outcome::converged);
  CHECK(s.levels[0].message.empty());
  CHECK(s.intersections == 0);
  CHECK(s.levels[0].seconds_by_phase.count("load stepping") == 1);
  int largest = 0, total = 0;
  for (const IncrementRow& increment : s.rows)
    if (increment.time != 1) {
      largest = std::max(largest, increment.iterations);
      total += increment.iterations;
    }
  return {largest, total};
}

}  // namespace

TEST_CASE("A cloth that a pin pulls through a slot follows in a few iterations an increment") {
  // The path is chaotic: single starts take 265 to 505 iterations.
  std::vector<int> largest, total;
  for (const int seed : {1, 2, 3, 4, 5}) {
    const auto [most, all] = iterations_of(filled(R"(name: slot
cloth: {shape: disc, radius: 0.15, vertices: 200}
levels: 1
start: {translate: [0, 0, 0.005], perturbation: 1e-9, seed: $}
pins: [{region: ball, point: [0, 0, 0], radius: 0.015, translate: [0, 0, 0.005]}]
energies: [neo_hookean, hinge, {type: strain_limit, limit: 1.2}, gravity]
contact: ipc
obstacles:
  - {name: left, meshed_shape: box, size: [0.3, 0.4, 0.04], translate: [-0.165, 0, -0.025]}
  - {name: right, meshed_shape: box, size: [0.3, 0.4, 0.04], translate: [0.165, 0, -0.025]}
friction: 0.1
schedule:
  steps: 20
  keys: [{parameter: pins.0.translate, times: [0, 1], values: [[0, 0, 0.005], [0, 0, -0.25]]}]
methods: {pcs: {}}
)",
                                                  seed));
    largest.push_back(most);
    total.push_back(all);
  }
  std::sort(largest.begin(), largest.end());
  std::sort(total.begin(), total.end());
  // By the penalty alone 361 in one increment, 600 in all.
  CHECK(largest[2] < 120);
  CHECK(total[2] < 400);
}

TEST_CASE("A strip that is twisted into itself follows in a few iterations an increment") {
  const auto [largest, total] = iterations_of(R"(name: twist
cloth: {shape: rectangle, size: [0.3, 0.12], triangulation: one_way, columns: 16, rows: 8}
levels: 1
material: {membrane_modulus: 1e6, bending_modulus: 1e6}
start: {perturbation: 1e-4}
pins:
  - {region: box, lower: [-1, -1, -1], upper: [0.001, 1, 1]}
  - {region: box, lower: [0.299, -1, -1], upper: [1, 1, 1], centre: [0.3, 0.06, 0]}
energies: [neo_hookean, hinge]
contact: {type: ipc, stiffness: 1.5e4}
friction: 0.1
schedule:
  steps: 30
  keys:
    - {parameter: pins.1.rotate, times: [0, 1], values: [[0, 0, 0], [900, 0, 0]]}
    - {parameter: pins.1.translate, times: [0, 1], values: [[0, 0, 0], [-0.12, 0, 0]]}
methods: {pcs: {}}
)");
  // By the penalty alone 67 in one increment, 450 in all.
  CHECK(largest < 35);
  CHECK(total < 200);
}
