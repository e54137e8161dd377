// What inflation owes: a sphere in closed form, and the mylar balloon.

#include <Eigen/Cholesky>

#include "core/numerics/mesh_files/io.h"
#include "tests/support/closed_meshes.h"
#include "tests/support/evaluate.h"
#include "tests/support/known_answers.h"
#include "tests/support/meshes.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

constexpr double tension = 1000;  // E d [N/m]

/// A closed mesh without bending stiffness, ν = 0, and a pressure in it, given over E d/m.
Solved balloon(const TriangleMesh& mesh, double load) {
  const Scratch folder;
  write_mesh(folder / "balloon.ply", mesh);
  return scene_from(experiment(R"(cloth: {shape: file, file: $}
material: {density: 1000, thickness: 1e-3, membrane_modulus: 1e6, bending_modulus: 0, poisson_ratio: 0}
energies: [neo_hookean, {type: pressure, pressure: $}]
newton: {force_tolerance: 1e-6, step_growth: 2, max_steps: 2000}
)",
                               (folder / "balloon.ply").string(), load * tension));
}

double volume(const Solved& s, const Positions& x) { return volume_of({x, s.level().rest.triangles}); }

/// Half of the balloon without wrinkles' detail: a surface of revolution whose hoops shorten at no cost
/// (tension field theory), as a chain of `segments` meridian segments from the pole to the rim, where the
/// radius at rest is 1 m. Energy μ d/2 Σ A (w(σ₁) + w(σ₂)), w(σ) = σ² - 1 - 2 ln σ, 0 below 1: neo-Hookean, ν
/// = 0.
class Chain {
 public:
  explicit Chain(int segments) : n_(segments), q_(2 * segments + 2) {
    for (int i = 0; i <= n_; ++i) {
      const double s = static_cast<double>(i) / n_;
      q_.segment<2>(2 * i) << s * (1 - 0.2 * s * s), 0.45 * (1 - s * s);
    }
  }

  /// Moves to the minimum of the energy minus p V.
  void solve(double load) {
    const double pressure = load * tension;
    const auto gradient = [&](const Eigen::VectorXd& q) {
      Eigen::VectorXd g;
      energy(q, pressure, g);
      g[0] = g[q.size() - 1] = 0;  // the pole stays on the axis, the rim in the plane
      return g;
    };
    for (int i = 0; i < 500; ++i) {
      const Eigen::VectorXd g = gradient(q_);
      if (g.norm() <= 1e-8 * pressure) return;
      Eigen::MatrixXd h = differences(gradient, q_, 1e-7);
      for (const Eigen::Index fixed : {Eigen::Index(0), q_.size() - 1})
        h.col(fixed).setZero(), h(fixed, fixed) = 1;
      h = (h + h.transpose()).eval() / 2;
      Eigen::LLT<Eigen::MatrixXd> factor(h);
      for (double shift = 1e-9 * h.diagonal().maxCoeff(); factor.info() != Eigen::Success; shift *= 10)
        factor.compute(h + shift * Eigen::MatrixXd::Identity(q_.size(), q_.size()));
      const Eigen::VectorXd p = -factor.solve(g);
      const double before = energy(q_, pressure), noise = 1e-13 * std::abs(before);
      double step = 1;
      while (energy(q_ + step * p, pressure) > before + 1e-4 * step * g.dot(p) + noise) step /= 2;
      q_ += step * p;
    }
    FAIL("the reference balloon does not converge");
  }

  /// Of the whole balloon.
  double volume() const { return 2 * (energy(q_, 0) - energy(q_, 1)); }
  double rim() const { return q_[q_.size() - 2]; }
  double height() const { return 2 * q_[1]; }

 private:
  double energy(const Eigen::VectorXd& q, double pressure) const {
    Eigen::VectorXd unused;
    return energy(q, pressure, unused);
  }

  /// Energy of half a balloon minus p V, and its gradient.
  double energy(const Eigen::VectorXd& q, double pressure, Eigen::VectorXd& g) const {
    const auto w = [](double x) { return x * x - 1 - 2 * std::log(x); };
    double sum = 0;
    g.setZero(q.size());
    for (int i = 0; i < n_; ++i) {
      const double ds = 1. / n_, s = (i + 0.5) * ds, scale = tension / 4 * 2 * M_PI * s * ds;
      const double a = q[2 * i], b = q[2 * i + 2], dz = q[2 * i + 1] - q[2 * i + 3];
      const Eigen::Vector2d along(b - a, -dz);
      const double s1 = along.norm() / ds, s2 = (a + b) / (2 * s);
      const Eigen::Vector2d pull = scale * (2 * s1 - 2 / s1) / ds * along.normalized();
      const double hoop = s2 > 1 ? scale * (2 * s2 - 2 / s2) / (2 * s) : 0, third = M_PI / 3 * pressure,
                   rr = a * a + a * b + b * b;
      g.segment<4>(2 * i) +=
          Eigen::Vector4d(-pull.x() + hoop - third * (2 * a + b) * dz, -pull.y() - third * rr,
                          pull.x() + hoop - third * (a + 2 * b) * dz, pull.y() + third * rr);
      sum += scale * (w(s1) + (s2 > 1 ? w(s2) : 0)) - third * rr * dz;
    }
    return sum;
  }

  int n_;
  Eigen::VectorXd q_;  // r and z of every node
};

/// The stretch λ of a sphere with p R / E d = 1/λ - 1/λ³, before the pressure's maximum at √3.
double sphere_stretch(double load) {
  double low = 1, high = std::sqrt(3.0);
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (1 / middle - 1 / std::pow(middle, 3) < load ? low : high) = middle;
  }
  return low;
}

/// Blown up from a start with pleats: every other meridian is moved outwards, the others inwards.
Solved blown_up(int meridians, int rings, double load) {
  Solved s = balloon(cushion_mesh(1, meridians, rings, 1e-3), load);
  Positions& x = s.scene->starts.back();
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const double r = x.row(v).head<2>().norm(), pleat = (v % 2 ? 1.0 : -1.0) / meridians;
    x.row(v).head<2>() *= (1 - 0.2 * r * r) * (1 + pleat);
    x(v, 2) *= 450;
  }
  run_method(s);
  return converged(std::move(s));
}

}  // namespace

TEST_CASE("A sphere's volume follows its pressure in closed form") {
  const double radius = 0.3;
  table("Stretch of a sphere of radius R under a pressure", "p R/E d", "splits", "stretch", "exact", "error");
  for (const double load : {0.01, 0.1, 0.3}) {
    const double exact = sphere_stretch(load);
    check_convergence(load, {1, 2, 3}, exact, 0.01 * (exact - 1), [&](int splits) {
      Solved s = balloon(sphere_mesh(radius, splits), load / radius);
      run_method(s);
      s = converged(std::move(s));
      return std::cbrt(volume(s, s.x()) / volume(s, s.rest()));
    });
  }
}

TEST_CASE("The reference balloon is the mylar balloon where it hardly stretches") {
  // With the lemniscate's constant L = ∫ dt/√(1-t⁴): r = a/L, height 2 r ∫ t²/√(1-t⁴) dt = π/2 r²/a, and
  // V = 2π/3 a r² (Paulsen 1994; Mladenov and Oprea 2003).
  const double rim = 4 * std::sqrt(2 * M_PI) / std::pow(std::tgamma(0.25), 2), height = M_PI / 2 * rim * rim,
               volume = 2 * M_PI / 3 * rim * rim;
  CHECK(rim == Approx(0.7627).margin(1e-4));
  CHECK(height == Approx(0.9139).margin(1e-4));
  CHECK(volume == Approx(1.2185).margin(1e-4));
  table("Reference balloon: surface of revolution, hoops that shorten at no cost", "p a/E d", "V/a³", "r/a",
        "height/a");
  double excess = 1e9;
  Chain chain(200);
  for (const double load : {1e-1, 1e-2, 1e-3, 1e-4}) {
    chain.solve(load);
    CHECK(chain.volume() / volume - 1 < 0.2 * excess);
    excess = chain.volume() / volume - 1;
    row(load, chain.volume(), chain.rim(), chain.height());
  }
  row("0", volume, rim, height);
  CHECK(excess > 0);
  CHECK(excess < 5e-4);
  CHECK(chain.rim() == Approx(rim).epsilon(5e-4));
  CHECK(chain.height() == Approx(height).epsilon(2e-3));  // the pole is drawn out to a point
}

TEST_CASE("Two discs joined at their rims take in the mylar balloon's volume") {
  table("Balloon of two discs", "p a/E d", "meridians", "rings", "V/a³", "reference", "short by");
  for (const double load : {1e-2, 3e-2, 1e-1}) {
    Chain chain(200);
    for (const double approach : {0.1, 0.03, 0.01})
      if (approach >= load) chain.solve(approach);
    std::vector<double> errors;
    for (const auto& [meridians, rings] : {std::pair(64, 8), std::pair(128, 12), std::pair(256, 16)}) {
      const Solved s = blown_up(meridians, rings, load);
      errors.push_back(1 - volume(s, s.x()) / chain.volume());
      row(load, meridians, rings, volume(s, s.x()), chain.volume(), errors.back());
    }
    INFO("p a/E d = " << load);
    // Pleats of finite width take in less: from below, and half the width, about half of it.
    CHECK(errors[1] < errors[0]);
    CHECK(errors[2] < 0.7 * errors[1]);
    CHECK(errors[2] > 0);
    CHECK(errors[2] < 0.015);
  }
}
