// What inflation owes: a sphere in closed form, and the mylar balloon.

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "core/numerics/mesh_files/io.h"
#include "tests/support/closed_meshes.h"
#include "tests/support/meshes.h"
#include "tests/support/strip.h"

using namespace drape;

namespace {

constexpr double modulus = 1e6, thickness = 1e-3;  // E d = 1000 N/m

/// A closed mesh without bending stiffness, ν = 0, and a pressure in it.
Solved balloon(const TriangleMesh& mesh, double pressure) {
  const Scratch folder;
  const std::string name = (folder / "balloon.ply").string();
  write_mesh(name, mesh);
  return scene_from("name: balloon\ncloth: {shape: file, file: " + name +
                    "}\nlevels: 1\nmaterial: {density: 1000, thickness: " + text(thickness) +
                    ", membrane_modulus: " + text(modulus) +
                    ", bending_modulus: 0, poisson_ratio: 0}\n"
                    "energies: [neo_hookean, {type: pressure, pressure: " +
                    text(pressure) +
                    "}]\nmethods: {newton: {}}\n"
                    "newton: {force_tolerance: 1e-6, step_growth: 2, max_steps: 2000}\n");
}

double volume(const Solved& s, const Positions& x) { return volume_of({x, s.level().rest.triangles}); }

/// Half of the balloon without wrinkles' detail: a surface of revolution whose hoops shorten at no cost
/// (tension field theory), as a chain of `segments` meridian segments from the pole to the rim. Energy
/// μ d/2 Σ A (w(σ₁) + w(σ₂)), w(σ) = σ² - 1 - 2 ln σ, 0 below 1: neo-Hookean, ν = 0.
class Chain {
 public:
  Chain(double radius, int segments) : n_(segments), radius_(radius), q_(2 * segments + 2) {
    for (int i = 0; i <= n_; ++i) {
      const double s = static_cast<double>(i) / n_;
      q_[2 * i] = radius * s * (1 - 0.2 * s * s), q_[2 * i + 1] = 0.45 * radius * (1 - s * s);
    }
  }

  /// Moves to the minimum of the energy minus p V.
  void solve(double pressure) {
    for (int i = 0; i < 500; ++i) {
      Eigen::VectorXd g = Eigen::VectorXd::Zero(q_.size());
      Eigen::MatrixXd h = Eigen::MatrixXd::Zero(q_.size(), q_.size());
      const double before = assemble(q_, pressure, &g, &h);
      g[0] = g[q_.size() - 1] = 0;  // the pole stays on the axis, the rim in the plane
      if (g.norm() <= 1e-8 * pressure * radius_ * radius_) return;
      for (Eigen::Index fixed : {Eigen::Index(0), q_.size() - 1})
        h.row(fixed).setZero(), h.col(fixed).setZero(), h(fixed, fixed) = 1;
      Eigen::VectorXd p;
      for (double shift = 0;; shift = std::max(10 * shift, 1e-9 * h.diagonal().maxCoeff())) {
        const Eigen::LLT<Eigen::MatrixXd> factor(h + shift * Eigen::MatrixXd::Identity(q_.size(), q_.size()));
        if (factor.info() != Eigen::Success) continue;
        p = -factor.solve(g);
        break;
      }
      double step = 1;
      const double noise = 1e-13 * std::abs(before);
      while (assemble(q_ + step * p, pressure) > before + 1e-4 * step * g.dot(p) + noise) step /= 2;
      q_ += step * p;
    }
    FAIL("the reference balloon does not converge");
  }

  /// Of the whole balloon.
  double volume() const {
    double sum = 0;
    for (int i = 0; i < n_; ++i) {
      const double a = q_[2 * i], b = q_[2 * i + 2];
      sum += 2 * M_PI / 3 * (a * a + a * b + b * b) * (q_[2 * i + 1] - q_[2 * i + 3]);
    }
    return sum;
  }
  double rim() const { return q_[q_.size() - 2]; }
  double height() const { return 2 * q_[1]; }

 private:
  /// Energy of half a balloon, its gradient and Hessian, which is taken from differences of the gradient.
  double assemble(const Eigen::VectorXd& q, double pressure, Eigen::VectorXd* g = nullptr,
                  Eigen::MatrixXd* h = nullptr) const {
    double sum = 0;
    for (int i = 0; i < n_; ++i) {
      const Eigen::Vector4d own = q.segment<4>(2 * i);
      Eigen::Vector4d gradient;
      sum += segment(i, own, pressure, gradient);
      if (g) g->segment<4>(2 * i) += gradient;
      if (!h) continue;
      const double e = 1e-7 * radius_;
      Eigen::Matrix4d hessian;
      for (int c = 0; c < 4; ++c) {
        Eigen::Vector4d up, down;
        segment(i, own + e * Eigen::Vector4d::Unit(c), pressure, up);
        segment(i, own - e * Eigen::Vector4d::Unit(c), pressure, down);
        hessian.col(c) = (up - down) / (2 * e);
      }
      h->block<4, 4>(2 * i, 2 * i) += (hessian + hessian.transpose()) / 2;
    }
    return sum;
  }

  double segment(int i, const Eigen::Vector4d& q, double pressure, Eigen::Vector4d& g) const {
    const double ds = radius_ / n_, s = (i + 0.5) * ds, scale = modulus * thickness / 4 * 2 * M_PI * s * ds;
    const Eigen::Vector2d along(q[2] - q[0], q[3] - q[1]);
    const double s1 = along.norm() / ds, s2 = (q[0] + q[2]) / (2 * s);
    const auto w = [](double x) { return x > 1 ? x * x - 1 - 2 * std::log(x) : 0; };
    const auto dw = [](double x) { return x > 1 ? 2 * x - 2 / x : 0; };
    const Eigen::Vector2d pull = scale * (2 * s1 - 2 / s1) / ds * along.normalized();
    const double hoop = scale * dw(s2) / (2 * s), third = M_PI / 3 * pressure, dz = q[1] - q[3],
                 rr = q[0] * q[0] + q[0] * q[2] + q[2] * q[2];
    g << -pull.x() + hoop - third * (2 * q[0] + q[2]) * dz, -pull.y() - third * rr,
        pull.x() + hoop - third * (q[0] + 2 * q[2]) * dz, pull.y() + third * rr;
    return scale * (s1 * s1 - 1 - 2 * std::log(s1) + w(s2)) - third * rr * dz;
  }

  int n_;
  double radius_;
  Eigen::VectorXd q_;  // r and z of every node
};

/// The stretch λ of a sphere with p R / E d = 1/λ - 1/λ³, before the pressure's maximum at √3.
double sphere_stretch(double pressure) {
  double low = 1, high = std::sqrt(3.0);
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (1 / middle - 1 / std::pow(middle, 3) < pressure ? low : high) = middle;
  }
  return low;
}

/// Under the pressure, from a start with pleats: every other meridian is moved outwards, the others inwards.
Solved blown_up(int meridians, int rings, double pressure) {
  Solved s = balloon(cushion_mesh(1, meridians, rings, 1e-3), pressure);
  Positions& x = s.scene->starts.back();
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const double r = x.row(v).head<2>().norm(), pleat = (v % 2 ? 1.0 : -1.0) / meridians;
    x.row(v).head<2>() *= (1 - 0.2 * r * r) * (1 + pleat);
    x(v, 2) *= 450;
  }
  run_method(s);
  return s;
}

}  // namespace

TEST_CASE("A sphere's volume follows its pressure in closed form", "[physics]") {
  row("\nStretch of a sphere of radius R under a pressure");
  row("%10s %10s %12s %12s %10s", "p R/E d", "triangles", "stretch", "exact", "error");
  for (const double load : {0.01, 0.1, 0.3}) {
    const double radius = 0.3, exact = sphere_stretch(load);
    std::vector<double> errors;
    for (const int splits : {1, 2, 3}) {
      Solved s = balloon(sphere_mesh(radius, splits), load * modulus * thickness / radius);
      run_method(s);
      s = converged(std::move(s));
      const double stretch = std::cbrt(volume(s, s.x()) / volume(s, s.rest()));
      errors.push_back(std::abs(stretch - exact));
      row("%10g %10d %12.6f %12.6f %10.1e", load, s.level().triangle_count(), stretch, exact, errors.back());
    }
    check_order(errors, 2);
    CHECK(errors.back() < 0.01 * (exact - 1));
  }
}

TEST_CASE("The reference balloon is the mylar balloon where it hardly stretches", "[physics]") {
  // With the lemniscate's constant L = ∫ dt/√(1-t⁴): r = a/L, height 2 r ∫ t²/√(1-t⁴) dt = π/2 r²/a, and
  // V = 2π/3 a r² (Paulsen 1994; Mladenov and Oprea 2003).
  const double lemniscate = std::pow(std::tgamma(0.25), 2) / (4 * std::sqrt(2 * M_PI));
  const double rim = 1 / lemniscate, height = M_PI / 2 * rim * rim, volume = 2 * M_PI / 3 * rim * rim;
  CHECK(rim == Approx(0.7627).margin(1e-4));
  CHECK(height == Approx(0.9139).margin(1e-4));
  CHECK(volume == Approx(1.2185).margin(1e-4));
  row("\nReference balloon: surface of revolution, hoops that shorten at no cost");
  row("%10s %10s %10s %10s", "p a/E d", "V/a³", "r/a", "height/a");
  std::vector<double> excess;
  Chain chain(1, 200);
  for (const double load : {1e-1, 1e-2, 1e-3, 1e-4}) {
    chain.solve(load * modulus * thickness);
    excess.push_back(chain.volume() / volume - 1);
    row("%10g %10.6f %10.6f %10.6f", load, chain.volume(), chain.rim(), chain.height());
  }
  row("%10s %10.6f %10.6f %10.6f", "0", volume, rim, height);
  for (std::size_t i = 1; i < excess.size(); ++i) CHECK(excess[i] < 0.2 * excess[i - 1]);
  CHECK(excess.back() > 0);
  CHECK(excess.back() < 5e-4);
  CHECK(chain.rim() == Approx(rim).epsilon(5e-4));
  CHECK(chain.height() == Approx(height).epsilon(2e-3));  // the pole is drawn out to a point
}

TEST_CASE("Two discs joined at their rims take in the mylar balloon's volume", "[physics]") {
  row("\nBalloon of two discs");
  row("%10s %10s %6s %10s %10s %8s %10s", "p a/E d", "meridians", "rings", "V/a³", "reference", "error",
      "iterations");
  for (const double load : {1e-2, 3e-2, 1e-1}) {
    Chain chain(1, 200);
    for (const double approach : {0.1, 0.03, 0.01})
      if (approach >= load) chain.solve(approach * modulus * thickness);
    std::vector<double> errors;
    for (const auto& [meridians, rings] : {std::pair(64, 8), std::pair(128, 12), std::pair(256, 16)}) {
      const Solved s = converged(blown_up(meridians, rings, load * modulus * thickness));
      const double found = volume(s, s.x());
      errors.push_back(1 - found / chain.volume());
      row("%10g %10d %6d %10.5f %10.5f %7.2f%% %10d", load, meridians, rings, found, chain.volume(),
          -100 * errors.back(), s.levels.back().iterations);
    }
    INFO("p a/E d = " << load);
    // Pleats of finite width take in less: from below, and half the width, about half of it.
    CHECK(errors[1] < errors[0]);
    CHECK(errors[2] < 0.7 * errors[1]);
    CHECK(errors[2] > 0);
    CHECK(errors[2] < 0.015);
  }
}
