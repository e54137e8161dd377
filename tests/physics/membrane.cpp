#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "tests/support/strip.h"

using namespace drape;

namespace {

const std::string membranes[] = {"neo_hookean", "stvk"};

struct Sheet {
  Eigen::Vector2d size;
  std::string triangulation;  ///< YAML keys of `cloth`
  double density = 1000, thickness = 0.01, modulus = 1e5, poisson_ratio = 0;

  std::string yaml(const std::string& more) const {
    return "name: sheet\nlevels: 1\ncloth: {shape: rectangle, size: [" + text(size.x()) + ", " +
           text(size.y()) + "], " + triangulation + "}\nmaterial: {density: " + text(density) +
           ", thickness: " + text(thickness) + ", membrane_modulus: " + text(modulus) +
           ", bending_modulus: 0, poisson_ratio: " + text(poisson_ratio) + "}\nmethods: {newton: {}}\n" +
           more;
  }
};

/// Energy of a homogeneous stretch over rest volume, as it is documented (docs/theory/method.md, section 5).
double energy_density(const std::string& membrane, double modulus, double nu, double s1, double s2) {
  const double mu = modulus / (2 * (1 + nu)), lambda = modulus * nu / (1 - nu * nu);
  if (membrane == "stvk") {
    const double g1 = (s1 * s1 - 1) / 2, g2 = (s2 * s2 - 1) / 2;
    return mu * (g1 * g1 + g2 * g2) + lambda / 2 * (g1 + g2) * (g1 + g2);
  }
  const double log_j = std::log(s1 * s2);
  return mu / 2 * (s1 * s1 + s2 * s2 - 2 - 2 * log_j) + lambda / 2 * log_j * log_j;
}

/// Stretches that minimise ψ(σ₁, σ₂) − P₁ σ₁, by half of Newton's steps with the stiffness at rest.
Eigen::Vector2d uniaxial_stretches(const std::string& membrane, double modulus, double nu, double stress) {
  const double h = 1e-3;  // of differences of fourth order, exact to 1e-12
  Eigen::Matrix2d stiffness;
  stiffness << 1, nu, nu, 1;
  stiffness *= modulus / (1 - nu * nu);
  Eigen::Vector2d s(1, 1);
  for (int i = 0; i < 200; ++i) {
    const auto slope = [&](const Eigen::Vector2d& along) {
      const auto at = [&](double step) {
        return energy_density(membrane, modulus, nu, s[0] + step * along[0], s[1] + step * along[1]);
      };
      return (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    };
    const Eigen::Vector2d residual(slope({1, 0}) - stress, slope({0, 1}));
    s -= stiffness.inverse() * residual / 2;
  }
  return s;
}

/// A traction [N/m] on both ends of the sheet along x, as point forces on their vertices: half of each border
/// edge's share to either of its vertices. An item of `energies`.
std::string end_tractions(const Solved& s, double length, double traction) {
  const Positions& rest = s.rest();
  std::vector<double> force(rest.rows(), 0);
  for (int e = 0; e < s.level().topology.edges.rows(); ++e) {
    const int a = s.level().topology.edges(e, 0), b = s.level().topology.edges(e, 1);
    for (double end : {0.0, length})
      if (rest(a, 0) == end && rest(b, 0) == end)
        for (int v : {a, b})
          force[v] += (end == 0 ? -0.5 : 0.5) * traction * (rest.row(a) - rest.row(b)).norm();
  }
  std::string points;
  for (std::size_t v = 0; v < force.size(); ++v)
    if (force[v] != 0)
      points += (points.empty() ? "" : ", ") + std::string("{point: ") + text(Eigen::Vector3d(rest.row(v))) +
                ", force: " + text({force[v], 0, 0}) + "}";
  return "{type: constant_load, points: [" + points + "]}";
}

std::string newton_to(double tolerance) {
  return "newton: {step_size: 0.01, step_growth: 2, max_steps: 200, force_tolerance: " + text(tolerance) +
         "}\n";
}

/// Under its weight, along x from its end.
Solved hung(const Sheet& sheet, const std::string& membrane) {
  return converged(solve_yaml(sheet.yaml("energies: [" + membrane +
                                         ", gravity]\nstart: {rotate: [0, 90, 0]}\n"
                                         "pins: [{region: box, lower: [0, 0, 0], upper: [0, 1, 0]}]\n" +
                                         newton_to(1e-6))));
}

}  // namespace

TEST_CASE("A strip that hangs stretches by rho g L² / 2E", "[physics]") {
  const double length = 1, strain = 3e-6;  // ρ g L / E
  row("\nHanging strip: u over rho g L² / E, at the end and largest error over all vertices, rho g L / E = "
      "%g",
      strain);
  row("%12s %10s %12s %14s %14s", "membrane", "vertices", "end (mean)", "exactly 0.5 +", "vertex error");
  for (const std::string& membrane : membranes) {
    std::vector<double> errors;
    for (int vertices : {60, 240, 960, 3840}) {
      Sheet sheet{{length, 0.4}, "triangulation: random, vertices: " + std::to_string(vertices)};
      sheet.modulus = sheet.density * 9.81 * length / strain;
      const Solved s = hung(sheet, membrane);
      double worst = 0, end = 0;
      int ends = 0;
      for (Eigen::Index i = 0; i < s.x().rows(); ++i) {
        const double z = s.rest()(i, 0), u = (-s.x()(i, 2) - z) / (strain * length);
        worst = std::max(worst, std::abs(u - (z - z * z / 2)));
        if (z == length) end += u, ++ends;
      }
      REQUIRE(ends > 2);
      errors.push_back(worst);
      row("%12s %10d %12.7f %14.2e %14.2e", membrane.c_str(), vertices, end / ends, end / ends - 0.5, worst);
    }
    INFO(membrane);
    check_order(errors, 2);
    CHECK(errors.back() < 1e-3);
  }
}

TEST_CASE("A grid that hangs has the exact displacement at every row", "[physics]") {
  const double strain = 3e-6;
  row("\nHanging grid of 21 × 9 vertices: largest error of a row's mean u over rho g L² / E");
  for (const std::string& membrane : membranes)
    for (const std::string triangulation : {"one_way", "criss_cross"}) {
      Sheet sheet{{1, 0.4}, "triangulation: " + triangulation + ", columns: 21, rows: 9"};
      sheet.modulus = sheet.density * 9.81 / strain;
      const Solved s = hung(sheet, membrane);
      double worst = 0;
      for (int i = 1; i < 21; ++i) {
        double mean = 0;  // over the width: vertices at the sides stand for half a cell
        for (int j = 0; j < 9; ++j)
          mean +=
              (j == 0 || j == 8 ? 0.5 : 1) / 8 * (-s.x()(i + 21 * j, 2) - s.rest()(i + 21 * j, 0)) / strain;
        const double z = i / 20.0;
        worst = std::max(worst, std::abs(mean - (z - z * z / 2)));
      }
      row("%12s %12s %10.1e", membrane.c_str(), triangulation.c_str(), worst);
      INFO(membrane << ", " << triangulation);
      CHECK(worst < 3 * strain);  // what finite strain makes of it
    }
}

TEST_CASE("A sheet under end tractions stretches homogeneously, exactly", "[physics]") {
  row("\nUniaxial stretch, nu = 0.3");
  row("%12s %36s %8s %12s %12s %12s", "membrane", "mesh", "P/E", "sigma1", "sigma2", "error");
  const std::string meshes[] = {
      "triangulation: one_way, columns: 4, rows: 3", "triangulation: one_way, columns: 13, rows: 9",
      "triangulation: criss_cross, columns: 7, rows: 5", "triangulation: random, vertices: 80"};
  for (const std::string& membrane : membranes)
    for (double load : {0.05, 0.15, 0.4})
      for (const std::string& mesh : meshes) {
        Sheet sheet{{1, 0.75}, mesh};
        sheet.poisson_ratio = 0.3;
        const double stress = load * sheet.modulus;
        const Eigen::Vector2d stretch =
            uniaxial_stretches(membrane, sheet.modulus, sheet.poisson_ratio, stress);
        const std::string pin = "pins: [{region: nearest, point: [0, 0, 0]}]\n" + newton_to(1e-9);
        const Solved bare = scene_from(sheet.yaml("energies: [" + membrane + "]\n" + pin));
        const std::string load_item = end_tractions(bare, 1, stress * sheet.thickness);
        INFO(membrane << ", " << mesh << ", " << load);
        const Solved s =
            converged(solve_yaml(sheet.yaml("energies: [" + membrane + ", " + load_item + "]\n" + pin)));

        // Up to a rotation, which the pin leaves free: compare distances from it.
        double worst = 0;
        for (Eigen::Index i = 0; i < s.x().rows(); ++i)
          for (Eigen::Index j = 0; j < i; ++j) {
            const Eigen::RowVector3d X = s.rest().row(i) - s.rest().row(j);
            const double expected = std::hypot(stretch[0] * X[0], stretch[1] * X[1]);
            worst = std::max(worst, std::abs((s.x().row(i) - s.x().row(j)).norm() - expected));
          }
        row("%12s %36s %8g %12.8f %12.8f %12.1e", membrane.c_str(), mesh.substr(15).c_str(), load, stretch[0],
            stretch[1], worst);
        CHECK(worst < 1e-8);
      }
}
