#include <catch2/catch.hpp>
#include <cmath>

#include "core/kernel/interfaces/energy.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/strip.h"

using namespace drape;

namespace {

/// Material with k = E_bend d³ / 24 (1 − ν²) = 1 J.
const Material material = [] {
  Material m;
  m.thickness = 0.01;
  m.poisson_ratio = 0.3;
  m.bending_modulus = 24 * (1 - 0.09) / 1e-6;
  return m;
}();

double bending_energy(const TriangleMesh& rest, const Positions& x) {
  return make_plugin_from<Energy>("hinge")->bind(Level::of(0, rest), material)->value(x);
}

template <Diagonals diagonals>
TriangleMesh squares(int n, double a) {
  return grid({n * a, n * a}, n + 1, n + 1, diagonals);
}

/// Equilateral triangles of side a in the shape of a parallelogram of n × n cells.
TriangleMesh equilateral(int n, double a) {
  TriangleMesh mesh = squares<Diagonals::one_way>(n, a);
  for (Eigen::Index i = 0; i < mesh.vertices.rows(); ++i) {
    mesh.vertices(i, 0) -= mesh.vertices(i, 1) / 2;
    mesh.vertices(i, 1) *= std::sqrt(0.75);
  }
  return mesh;
}

struct Pattern {
  std::string name;
  double cell_area;  ///< over a²
  TriangleMesh (*patch)(int n, double a);
  /// Factors of k κ² that follow from the pattern's hinges for a cylinder whose axis is along y, one that
  /// bends along (1, 1), one that bends along (1, -1), for a sphere and for a saddle.
  double expected[5];
};

const Pattern patterns[] = {{"one_way", 1, squares<Diagonals::one_way>, {3, 9, 3, 6, 6}},
                            {"criss_cross", 1, squares<Diagonals::criss_cross>, {3, 4.5, 4.5, 6, 6}},
                            {"equilateral", std::sqrt(0.75), equilateral, {3, 3, 3, 4, 8}}};

/// f(n) = A n² + B n + C, an energy of n × n cells: A.
template <class Function>
double per_cell(const Function& f) {
  const int n = 4;
  return (f(3 * n) - 2 * f(2 * n) + f(n)) / (2 * n * n);
}

/// Energy density over k κ² of the pattern where its vertices lie on z = ½ κ (p·A p).
double bending_energy_density(const Pattern& pattern, const Eigen::Matrix2d& shape) {
  const double a = 0.1, curvature = 1e-4;
  const auto energy = [&](int n) {
    const TriangleMesh rest = pattern.patch(n, a);
    Positions x = rest.vertices;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const Eigen::Vector2d p = x.row(i).head<2>();
      x(i, 2) = curvature / 2 * p.dot(shape * p);
    }
    return bending_energy(rest, x);
  };
  return per_cell(energy) / (pattern.cell_area * a * a * curvature * curvature);
}

/// D_eff / k of a lattice of criss-cross cells a × r a bent along x, with every other vertex raised by the q
/// of least energy.
double relaxed_stiffness(double r) {
  const double a = 0.1, curvature = 1e-4, step = curvature * a * a / 10;
  const auto energy = [&](double q) {
    return per_cell([&](int n) {
      const TriangleMesh rest = grid({n * a, n * r * a}, n + 1, n + 1, Diagonals::criss_cross);
      Positions x = rest.vertices;
      for (Eigen::Index i = 0; i < x.rows(); ++i)
        x(i, 2) = curvature / 2 * x(i, 0) * x(i, 0) + ((i % (n + 1) + i / (n + 1)) % 2 == 0 ? q : 0);
      return bending_energy(rest, x);
    });
  };
  const double minus = energy(-step), zero = energy(0), plus = energy(step), bend = plus - 2 * zero + minus;
  REQUIRE(bend > 0);
  const double least = zero - (plus - minus) * (plus - minus) / (8 * bend);
  return 2 * least / (r * a * a * curvature * curvature);
}

/// D_eff / k of a strip under a small load at its end.
double strip_stiffness(double r) {
  BeamStrip strip{20};
  strip.stiffness = 100;  // were it 6 k
  strip.slenderness = r;
  const double alpha = 0.01, load = alpha * strip.stiffness * strip.width();
  INFO("r = " << r);
  const Solved s =
      converged(solve_yaml(strip.yaml("[neo_hookean, hinge, " + strip.end_load({0, 0, -load}) + "]",
                                      "newton: {step_size: 0.1, step_growth: 2,"
                                      " force_tolerance: 1e-4, max_steps: 500}\n")));
  // The deflection of a chain of hinges of stiffness 6 k is less than that of the beam by its lumping.
  const double chain = alpha / 3 * (1 - 0.25 / std::pow(strip.cells - 0.5, 2));
  return 6 * chain / -place(s, strip.cells, strip.cells).z();
}

}  // namespace

TEST_CASE("What the hinge model charges for a curvature depends on the triangulation", "[physics]") {
  const double h = 0.5;
  Eigen::Matrix2d shapes[5];
  shapes[0] << 1, 0, 0, 0;    // bent along x
  shapes[1] << h, h, h, h;    // bent along (1, 1)
  shapes[2] << h, -h, -h, h;  // bent along (1, -1)
  shapes[3] << 1, 0, 0, 1;    // a sphere
  shapes[4] << 1, 0, 0, -1;   // a saddle
  row("\nBending energy density over k kappa², vertices on the surface");
  row("%14s %12s %12s %12s %10s %10s", "triangles", "along x", "along (1,1)", "along (1,-1)", "sphere",
      "saddle");
  for (const Pattern& pattern : patterns) {
    double d[5];
    for (int i = 0; i < 5; ++i) {
      d[i] = bending_energy_density(pattern, shapes[i]);
      INFO(pattern.name << ", shape " << i);
      CHECK(d[i] == Approx(pattern.expected[i]).epsilon(1e-5));
    }
    row("%14s %12.5f %12.5f %12.5f %10.5f %10.5f", pattern.name.c_str(), d[0], d[1], d[2], d[3], d[4]);
  }
}

TEST_CASE("Wide cells make cloth softer: their diagonals bend along", "[physics]") {
  row("\nStiffness D_eff / k along x of a criss-cross of cells a × r a, free to move every other vertex by "
      "q");
  row("%8s %12s %12s %26s", "r", "lattice", "by formula", "strip of 2 × 20 cells");
  double last = 7;
  for (double r : {0.06, 0.25, 0.5, 1.0, 2.0}) {
    const double lattice = relaxed_stiffness(r), strip = strip_stiffness(r);
    // 3 k [r² (κ a + 2 q/a)² + (2 q)² (1/r² + (1 + r²)²/r²)/a²] a cell, at its least by q.
    const double formula = 6 * (1 - std::pow(r, 4) / (2 * (1 + r * r + std::pow(r, 4))));
    row("%8g %12.5f %12.5f %26.4f", r, lattice, formula, strip);
    INFO("r = " << r);
    CHECK(lattice == Approx(formula).epsilon(1e-5));
    CHECK(strip == Approx(formula).epsilon(0.05));  // its sides are free
    CHECK(strip < last);
    if (r == 0.06) CHECK(strip == Approx(6).epsilon(1e-4));
    last = strip;
  }
}
