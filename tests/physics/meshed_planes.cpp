// A plane is a plane, whatever the triangles that it is made of.

#include <map>
#include <random>
#include <set>

#include "core/numerics/contact_forces/contact_stiffness.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/known_answers.h"
#include "tests/support/meshes.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

constexpr double gravity = 9.81, dhat = 1e-3;

/// The gap [m] at which the barrier b(s) = -(s - 1)² ln s carries a pressure [Pa].
double resting_gap(double pressure, double stiffness) {
  const auto slope = [](double s) { return 2 * (s - 1) * std::log(s) + (s - 1) * (s - 1) / s; };  // of -b
  double low = 1e-12, high = 1;
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (stiffness * slope(middle) > pressure ? low : high) = middle;
  }
  return dhat * low;
}

/// A patch of cotton at rest on the floor z = 0, under gravity that is turned by `angle` from the vertical.
/// `contact` is a contact model, and the key `obstacles` on a line of its own.
std::string on_a_slope(double angle, double friction, const std::string& contact, const std::string& newton) {
  const Material cotton;
  const double pressure = cotton.area_density() * gravity * std::cos(angle);
  return experiment(R"(cloth: {shape: square, side: 0.1, columns: 6, rows: 6}
start: {translate: [-0.05, -0.05, $]}
energies: [neo_hookean, hinge, {type: gravity, acceleration: [$, 0, $]}]
contact: $
friction: $
newton: {$}
)",
                    resting_gap(pressure, contact_stiffness(cotton)), gravity * std::sin(angle),
                    -gravity * std::cos(angle), contact, friction, newton);
}

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
struct Floors : Scratch {
  std::vector<Floor> all = {
      {"half-space", "shapes\nobstacles: [{name: floor, shape: half_space}]", true},
      {"box of twelve triangles",
       "ipc\nobstacles: [{name: floor, meshed_shape: box, size: [4, 4, 1], translate: [0.5, 0, -0.5]}]",
       true}};

  Floors() {
    for (const auto& [name, cell, jitter, uneven] :
         {std::tuple("two triangles", 0.6, 0.0, 0.0), std::tuple("0.1 m", 0.1, 0.0, 0.0),
          std::tuple("0.025 m", 0.025, 0.0, 0.0), std::tuple("0.01 m", 0.01, 0.0, 0.0),
          std::tuple("0.025 m, jittered", 0.025, 0.3, 0.0),
          std::tuple("0.025 m, as flat as single precision", 0.025, 0.3, 2e-8)}) {
      const auto file = path / (std::to_string(all.size()) + ".ply");
      write_mesh(file, plane(cell, jitter, uneven));
      all.push_back({name, filled("ipc\nobstacles: [{name: floor, mesh: $}]", file.string()), false});
    }
  }
};

Eigen::VectorXd slid(const Solved& s) { return (s.x() - s.scene->starts.back()).col(0); }

/// Cloth sticks where the slope is this part below the coefficient of friction, and slides as much above it.
void check_friction(const Floor& floor, double mu, double margin, double step_size) {
  constexpr double epsilon = 1e-4;  // the default friction smoothing distance
  INFO(floor.name << ", mu " << mu);
  const Eigen::VectorXd crept = slid(converged(solve_yaml(
      on_a_slope(std::atan((1 - margin) * mu), mu, floor.contact, "force_tolerance: 1e-4, max_steps: 500"))));
  CHECK(crept.maxCoeff() < 2 * epsilon);
  if (floor.on_one_face) CHECK(crept.minCoeff() > 0);
  const Solved sliding = solve_yaml(
      on_a_slope(std::atan((1 + margin) * mu), mu, floor.contact,
                 filled("force_tolerance: 1e-4, max_steps: 60, step_growth: 1, step_size: $", step_size)));
  CHECK(sliding.levels.back().outcome == Outcome::max_steps_reached);
  CHECK(slid(sliding).minCoeff() > 10 * epsilon);
}

}  // namespace

TEST_CASE("Cloth rests at the gap at which the barrier carries its weight, on a plane of any triangles") {
  const Material cotton;
  const double expected = resting_gap(cotton.area_density() * gravity, contact_stiffness(cotton));
  REQUIRE(expected > 0.5e-3);
  const Floors floors;
  for (const auto& [name, contact, on_one_face] : floors.all) {
    INFO(name);
    Solved s = scene_from(
        on_a_slope(0, 0, contact, on_one_face ? "force_tolerance: 1e-8" : "force_tolerance: 1e-6"));
    for (Positions& start : s.scene->starts) start.col(2).setConstant(0.95e-3);
    run_method(s);
    s = converged(std::move(s));
    const double tolerance = on_one_face ? 1e-6 : 1e-4;
    CHECK(s.levels.back().smallest_gap.value() == Approx(expected).epsilon(tolerance));
    CHECK(s.x().col(2).maxCoeff() == Approx(expected).epsilon(tolerance));
  }
}

TEST_CASE("Without friction cloth slides down a plane of any triangles at 0.05 degrees") {
  double exact = 0;
  const Floors floors;
  for (const auto& [name, contact, on_one_face] : floors.all) {
    INFO(name);
    const Solved s =
        solve_yaml(on_a_slope(0.05 * M_PI / 180, 0, contact,
                              "force_tolerance: 1e-4, max_steps: 40, step_growth: 1, step_size: 0.2"));
    CHECK(s.levels.back().outcome == Outcome::max_steps_reached);
    const Eigen::VectorXd moved = slid(s);
    if (exact == 0) exact = moved.mean();
    CHECK(exact > 5e-3);
    CHECK(moved.minCoeff() == Approx(exact).epsilon(0.01));
    CHECK(moved.maxCoeff() == Approx(exact).epsilon(0.01));
  }
}

TEST_CASE("On a plane of any triangles friction holds to within 0.5 % of its coefficient") {
  const Floors floors;
  for (const Floor& floor : floors.all) {
    check_friction(floor, 0.4, 0.005, 0.1);
    if (floor.on_one_face)
      for (const double mu : {0.1, 0.3}) check_friction(floor, mu, 0.01, 0.05);
  }
}

namespace {

constexpr double rim = 0.053;       // x of the rim; the cloth's leading edge starts at x = 0.05 [m]
constexpr double advance = 0.3e-3;  // of the cloth in a step [m]

/// A square of 0.6 m in cells of this size, which ends at `rim`; with vertical sides, it is a box without a
/// floor.
TriangleMesh slab(double cell, bool with_sides) {
  TriangleMesh mesh = plane(cell, 0, 0);
  mesh.vertices.col(0).array() += rim - mesh.vertices.col(0).maxCoeff();
  if (!with_sides) return mesh;
  std::set<std::pair<int, int>> sides;  // of triangles, in their direction
  for (const auto& t : mesh.triangles.rowwise())
    for (int k = 0; k < 3; ++k) sides.emplace(t[k], t[(k + 1) % 3]);
  std::erase_if(sides, [all = sides](const auto& side) { return all.count({side.second, side.first}); });
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  std::map<int, int> below;  // vertices of the border, and those below them
  for (const auto& [a, b] : sides) {
    below[a] = static_cast<int>(mesh.vertices.rows() + vertices.size());
    vertices.push_back(mesh.vertices.row(a) - Eigen::RowVector3d(0, 0, 0.1));
  }
  for (const auto& [a, b] : sides) {
    triangles.emplace_back(b, a, below[a]);
    triangles.emplace_back(b, below[a], below[b]);
  }
  append(mesh, vertices, triangles);
  return mesh;
}

/// Displacements along the slope after so many steps of `advance` on a half-space.
Eigen::VectorXd moved(double degrees, const std::string& contact, int steps) {
  const double angle = degrees * M_PI / 180, h = std::sqrt(advance / (gravity * std::sin(angle)));
  const Solved s = solve_yaml(on_a_slope(
      angle, 0, contact,
      filled("force_tolerance: 1e-5, max_steps: $, step_growth: 1, iterations_per_step: 5, step_size: $",
             steps, h)));
  CHECK(s.levels.back().outcome == Outcome::max_steps_reached);
  return slid(s);
}

}  // namespace

// Up to its rim a flat surface is a half-space: cloth slides over the rim as if there were none.
TEST_CASE("Without friction cloth slides over the rim of a slab and of a box") {
  const Scratch folder;
  for (const double degrees : {0.1, 0.3, 0.6}) {
    // The leading vertices come within d̂ of the rim, but not past it.
    const int before = static_cast<int>(0.9 * (rim - 0.05) / advance);
    const Eigen::VectorXd expected =
        moved(degrees, "shapes\nobstacles: [{name: floor, shape: half_space}]", before);
    for (const bool with_sides : {false, true})
      for (const double cell : {0.1, 0.03}) {
        INFO(degrees << " degrees, cells of " << cell << " m" << (with_sides ? ", a box" : ""));
        const auto file = folder / filled("$_$_$.ply", degrees, cell, int(with_sides));
        write_mesh(file, slab(cell, with_sides));
        const std::string contact = filled("ipc\nobstacles: [{name: floor, mesh: $}]", file.string());
        CHECK((moved(degrees, contact, before) - expected).cwiseAbs().maxCoeff() < 0.01 * expected.mean());
        // The second row of vertices is 2 cm behind.
        const int after = before + 10;
        CHECK(moved(degrees, contact, after).minCoeff() > 0.99 * advance * after);
      }
  }
}
