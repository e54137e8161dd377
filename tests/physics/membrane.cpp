#include <Eigen/LU>

#include "tests/support/evaluate.h"
#include "tests/support/strip.h"

using namespace drape;

namespace {

const std::string membranes[] = {"neo_hookean", "stvk"};

/// A sheet 10 mm thick, by newton; `triangulation` and `more` are YAML keys of `cloth` and of the experiment.
std::string sheet(const Eigen::Vector2d& size, const std::string& triangulation, double modulus, double nu,
                  const std::string& energies, const std::string& more) {
  return experiment(R"(cloth: {shape: rectangle, size: [$, $], $}
material: {density: 1000, thickness: 0.01, membrane_modulus: $, bending_modulus: 0, poisson_ratio: $}
energies: [$]
$)",
                    size.x(), size.y(), triangulation, modulus, nu, energies, more);
}

/// Energy of a homogeneous stretch over rest volume, as it is documented (docs/theory/method.md, section 5).
double energy_density(const std::string& membrane, double modulus, double nu, const Eigen::Vector2d& s) {
  const double mu = modulus / (2 * (1 + nu)), lambda = modulus * nu / (1 - nu * nu);
  if (membrane == "stvk") {
    const Eigen::Vector2d g = (s.cwiseAbs2() - Eigen::Vector2d::Ones()) / 2;
    return mu * g.squaredNorm() + lambda / 2 * g.sum() * g.sum();
  }
  const double log_j = std::log(s.prod());
  return mu / 2 * (s.squaredNorm() - 2 - 2 * log_j) + lambda / 2 * log_j * log_j;
}

/// Stretches that minimise ψ(σ₁, σ₂) − P₁ σ₁, by half of Newton's steps with the stiffness at rest.
Eigen::Vector2d uniaxial_stretches(const std::string& membrane, double modulus, double nu, double stress) {
  const Eigen::Matrix2d stiffness = modulus / (1 - nu * nu) * Eigen::Matrix2d{{1, nu}, {nu, 1}};
  Eigen::Vector2d s(1, 1);
  for (int i = 0; i < 200; ++i) {
    const auto energy = [&](const Eigen::Vector2d& at) { return energy_density(membrane, modulus, nu, at); };
    const Eigen::Vector2d slopes = differences(energy, s, 1e-3).transpose();  // exact to 1e-12
    s -= stiffness.inverse() * (slopes - Eigen::Vector2d(stress, 0)) / 2;
  }
  return s;
}

/// A traction [N/m] on both ends of the sheet along x, as point forces on their vertices: half of each border
/// edge's share to either of its vertices. An item of `energies`.
std::string end_tractions(const Solved& s, double length, double traction) {
  const Positions& rest = s.rest();
  std::vector<double> force(rest.rows(), 0);
  for (const auto& edge : s.level().topology.edges.rowwise())
    for (const double end : {0.0, length})
      if (rest(edge[0], 0) == end && rest(edge[1], 0) == end)
        for (const int v : edge)
          force[v] += (end == 0 ? -0.5 : 0.5) * traction * (rest.row(edge[0]) - rest.row(edge[1])).norm();
  std::string points;
  for (std::size_t v = 0; v < force.size(); ++v)
    if (force[v] != 0)
      points += filled("{point: $, force: [$, 0, 0]}, ", Eigen::Vector3d(rest.row(v)), force[v]);
  return "{type: constant_load, points: [" + points + "]}";
}

constexpr double small_strain = 3e-6;  // ρ g L / E of sheets that hang, L = 1 m

/// Displacements down over ρ g L² / E of a sheet of 1 × 0.4 m that hangs from its end x = 0, ν = 0.
Eigen::VectorXd hung(const std::string& triangulation, const std::string& membrane, Positions& rest) {
  const Solved s = converged(solve_yaml(
      sheet({1, 0.4}, triangulation, 1000 * 9.81 / small_strain, 0, membrane + ", gravity",
            "start: {rotate: [0, 90, 0]}\npins: [{region: box, lower: [0, 0, 0], upper: [0, 1, 0]}]\n" +
                newton_to(1e-6, 200, 0.01))));
  rest = s.rest();
  return (-s.x().col(2) - rest.col(0)) / small_strain;
}

}  // namespace

TEST_CASE("A strip that hangs stretches by rho g L² / 2E") {
  table("Hanging strip, rho g L / E = 3e-6: largest error of u over rho g L² / E, and the mean at its end",
        "membrane", "vertices", "error", "exact", "error");
  for (const std::string& membrane : membranes)
    check_convergence(membrane, {60, 240, 960, 3840}, 0, 1e-3, [&](int vertices) {
      Positions rest;
      const Eigen::ArrayXd u = hung(filled("triangulation: random, vertices: $", vertices), membrane, rest),
                           z = rest.col(0), at_end = (z == 1).cast<double>();
      REQUIRE(at_end.sum() > 2);
      row("", "mean at end", (u * at_end).sum() / at_end.sum());
      return (u - (z - z.square() / 2)).abs().maxCoeff();
    });
}

TEST_CASE("A grid that hangs has the exact displacement at every row") {
  table("Hanging grid of 21 × 9 vertices: largest error of a row's mean u over rho g L² / E", "membrane",
        "triangles", "error");
  for (const std::string& membrane : membranes)
    for (const std::string triangulation : {"one_way", "criss_cross"}) {
      Positions rest;
      const Eigen::VectorXd u =
          hung("triangulation: " + triangulation + ", columns: 21, rows: 9", membrane, rest);
      double worst = 0;
      for (int i = 1; i < 21; ++i) {
        double mean = 0;  // over the width: vertices at the sides stand for half a cell
        for (int j = 0; j < 9; ++j) mean += (j == 0 || j == 8 ? 0.5 : 1) / 8 * u[i + 21 * j];
        const double z = i / 20.0;
        worst = std::max(worst, std::abs(mean - (z - z * z / 2)));
      }
      row(membrane, triangulation, worst);
      CHECK(worst < 3 * small_strain);  // what finite strain makes of it
    }
}

TEST_CASE("A sheet under end tractions stretches homogeneously, exactly") {
  const double modulus = 1e5, nu = 0.3;
  table("Uniaxial stretch, nu = 0.3", "membrane", "P/E", "sigma1", "sigma2", "error");
  for (const std::string& membrane : membranes)
    for (const double load : {0.05, 0.15, 0.4})
      for (const char* mesh : {"one_way, columns: 4, rows: 3", "one_way, columns: 13, rows: 9",
                               "criss_cross, columns: 7, rows: 5", "random, vertices: 80"}) {
        const Eigen::Vector2d stretch = uniaxial_stretches(membrane, modulus, nu, load * modulus);
        const auto with = [&](const std::string& energies) {
          return sheet({1, 0.75}, std::string("triangulation: ") + mesh, modulus, nu, energies,
                       "pins: [{region: nearest, point: [0, 0, 0]}]\n" + newton_to(1e-9, 200, 0.01));
        };
        const std::string tractions = end_tractions(scene_from(with(membrane)), 1, load * modulus * 0.01);
        INFO(membrane << ", " << mesh << ", " << load);
        const Solved s = converged(solve_yaml(with(membrane + ", " + tractions)));

        // Up to a rotation, which the pin leaves free: compare distances from it.
        double worst = 0;
        for (Eigen::Index i = 0; i < s.x().rows(); ++i)
          for (Eigen::Index j = 0; j < i; ++j) {
            const Eigen::RowVector3d X = s.rest().row(i) - s.rest().row(j);
            const double expected = std::hypot(stretch[0] * X[0], stretch[1] * X[1]);
            worst = std::max(worst, std::abs((s.x().row(i) - s.x().row(j)).norm() - expected));
          }
        row(membrane, load, stretch[0], stretch[1], worst, mesh);
        CHECK(worst < 1e-8);
      }
}
