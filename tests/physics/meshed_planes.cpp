// A plane is a plane, whatever the triangles that it is made of.

#include <catch2/catch.hpp>
#include <random>

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"
#include "tests/support/slope.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// A square of 0.6 m about the origin, in cells of this size; its inner vertices moved by a part of that in
/// the plane, and all across it, by `uneven` at most [m].
TriangleMesh plane(double cell, double jitter, double uneven) {
  const int columns = 1 + static_cast<int>(std::lround(0.6 / cell));
  TriangleMesh mesh = grid({0.6, 0.6}, columns, columns, Diagonals::criss_cross);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (auto v : mesh.vertices.rowwise()) {
    for (int c = 0; c < 2; ++c)
      if (v[c] > 1e-9 && v[c] < 0.6 - 1e-9) v[c] += jitter * cell * unit(random);
    v[2] += uneven * unit(random);
  }
  // So that cloth of 2 cm cells lies neither on its edges nor on its vertices.
  mesh.vertices.rowwise() -= Eigen::RowVector3d(0.3037, 0.2951, 0);
  return mesh;
}

struct Floor {
  std::string name, contact;
  bool on_one_face;  ///< the cloth is, so that nothing but the solver's tolerance blurs the plane
};

/// The same plane in many ways, the exact one first.
std::vector<Floor> floors(const Scratch& folder) {
  std::vector<Floor> all = {
      {"half-space", "shapes\nobstacles: [{name: floor, shape: half_space}]", true},
      {"box of twelve triangles",
       "ipc\nobstacles: [{name: floor, meshed_shape: box, size: [4, 4, 1], translate: [0.5, 0, -0.5]}]",
       true}};
  for (const auto& [name, cell, jitter, uneven] :
       {std::tuple("two triangles", 0.6, 0.0, 0.0), std::tuple("0.1 m", 0.1, 0.0, 0.0),
        std::tuple("0.025 m", 0.025, 0.0, 0.0), std::tuple("0.01 m", 0.01, 0.0, 0.0),
        std::tuple("0.025 m, jittered", 0.025, 0.3, 0.0),
        std::tuple("0.025 m, as flat as single precision", 0.025, 0.3, 2e-8)}) {
    const auto file = folder / (std::to_string(all.size()) + ".ply");
    write_mesh(file, plane(cell, jitter, uneven));
    all.push_back({name, "ipc\nobstacles: [{name: floor, mesh: " + file.string() + "}]", false});
  }
  return all;
}

/// Cloth sticks where the slope is this part below the coefficient of friction, and slides as much above it.
void check_friction(const Floor& floor, double mu, double margin, const std::string& step_size) {
  constexpr double epsilon = 1e-4;  // the default friction smoothing distance
  INFO(floor.name << ", mu " << mu);
  const Solved stuck = converged(solve_yaml(
      on_a_slope(std::atan((1 - margin) * mu), mu, floor.contact, "force_tolerance: 1e-4, max_steps: 500")));
  const Eigen::VectorXd crept = (stuck.x() - stuck.scene->starts.back()).col(0);
  CHECK(crept.maxCoeff() < 2 * epsilon);
  if (floor.on_one_face) CHECK(crept.minCoeff() > 0);
  const Solved slid =
      solve_yaml(on_a_slope(std::atan((1 + margin) * mu), mu, floor.contact,
                            "force_tolerance: 1e-4, max_steps: 60, step_growth: 1, step_size: " + step_size));
  CHECK(slid.levels.back().outcome == Outcome::max_steps_reached);
  CHECK((slid.x() - slid.scene->starts.back()).col(0).minCoeff() > 10 * epsilon);
}

}  // namespace

TEST_CASE("Cloth rests at the gap at which the barrier carries its weight, on a plane of any triangles") {
  const Scratch folder;
  const Material cotton;
  const double expected = resting_gap(cotton.area_density() * gravity, contact_stiffness(cotton), dhat);
  REQUIRE(expected > 0.5e-3);
  for (const auto& [name, contact, on_one_face] : floors(folder)) {
    INFO(name);
    const std::string newton = on_one_face ? "force_tolerance: 1e-8" : "force_tolerance: 1e-6";
    Solved s = scene_from(on_a_slope(0, 0, contact, newton));
    for (Positions& start : s.scene->starts) start.col(2).setConstant(0.95e-3);
    run_method(s);
    REQUIRE(s.levels.back().outcome == Outcome::converged);
    REQUIRE(s.levels.back().smallest_gap);
    const double tolerance = on_one_face ? 1e-6 : 1e-4;
    CHECK(*s.levels.back().smallest_gap == Approx(expected).epsilon(tolerance));
    CHECK(s.x().col(2).maxCoeff() == Approx(expected).epsilon(tolerance));
  }
}

TEST_CASE("Without friction cloth slides down a plane of any triangles at 0.05 degrees") {
  const Scratch folder;
  double exact = 0;
  for (const auto& [name, contact, on_one_face] : floors(folder)) {
    INFO(name);
    const Solved s =
        solve_yaml(on_a_slope(0.05 * M_PI / 180, 0, contact,
                              "force_tolerance: 1e-4, max_steps: 40, step_growth: 1, step_size: 0.2"));
    CHECK(s.levels.back().outcome == Outcome::max_steps_reached);
    const Positions moved = s.x() - s.scene->starts.back();
    if (exact == 0) exact = moved.col(0).mean();
    CHECK(exact > 5e-3);
    CHECK(moved.col(0).minCoeff() == Approx(exact).epsilon(0.01));
    CHECK(moved.col(0).maxCoeff() == Approx(exact).epsilon(0.01));
  }
}

TEST_CASE("On a plane of any triangles friction holds to within 0.5 % of its coefficient") {
  const Scratch folder;
  for (const Floor& floor : floors(folder)) {
    check_friction(floor, 0.4, 0.005, "0.1");
    if (!floor.on_one_face) continue;
    for (const double mu : {0.1, 0.3}) check_friction(floor, mu, 0.01, "0.05");
  }
}
