#include "core/numerics/model/smoothness_check.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/kernel/files/number_text.h"
#include "core/numerics/model/derivative_check.h"
#include "core/numerics/model/required.h"

namespace drape {

namespace {

constexpr int intervals = 64, halvings = 46;  // then even the root of an interval is small
constexpr double least_jump = 1e-6;           ///< over the largest of all paths [1]

/// x(t) = from + t step, t in [0, 1].
struct Path {
  Positions from, step;
  Eigen::Matrix2d f0, f1;  ///< deformation gradients in the plane at both ends
  bool is_flat = true;     ///< whether the rest shape is in a plane z = const, so that these give its strains
  double height = 0;       ///< out of the plane at t = 1, and its negative at t = 0 [m]

  /// Whether both principal stretches are equal at t: they change places there.
  bool exchanges_stretches(double t) const {
    const Eigen::Matrix2d f = at(t);
    return is_flat && height == 0 && (f - f(0, 0) * Eigen::Matrix2d::Identity()).norm() < 1e-8;
  }

  std::string place(double t) const {
    const auto text = [](double number) { return general_text(std::abs(number) < 1e-9 ? 0 : number, 3); };
    if (height > 0)
      return "where vertices are up to " + text(std::abs(2 * t - 1) * height) + " m out of the plane";
    const Eigen::Matrix2d f = at(t), c = f.transpose() * f;
    if (!is_flat)
      return "where x and y of the rest shape are multiplied by the matrix [" + text(f(0, 0)) + ", " +
             text(f(0, 1)) + "; " + text(f(1, 0)) + ", " + text(f(1, 1)) + "]";
    const double half = 0.5 * (c(0, 0) - c(1, 1)), mean = 0.5 * c.trace(), radius = std::hypot(half, c(0, 1));
    return "at strains g11 = " + text(0.5 * (c(0, 0) - 1)) + ", g22 = " + text(0.5 * (c(1, 1) - 1)) +
           ", g12 = " + text(0.5 * c(0, 1)) + ", which are stretches s1 = " + text(std::sqrt(mean + radius)) +
           ", s2 = " + text(std::sqrt(std::max(mean - radius, 0.0)));
  }

 private:
  Eigen::Matrix2d at(double t) const { return (1 - t) * f0 + t * f1; }
};

std::vector<Path> paths_of(const Level& level) {
  const Positions& rest = level.rest.vertices;
  std::vector<Path> paths;
  const auto add = [&](double warp0, double weft0, double shear0, double warp1, double weft1, double shear1) {
    Path path;
    path.f0 << warp0, shear0, 0, weft0;
    path.f1 << warp1, shear1, 0, weft1;
    path.is_flat = rest.col(2).maxCoeff() == rest.col(2).minCoeff();
    path.from = rest;
    path.step = Positions::Zero(rest.rows(), 3);
    path.from.leftCols<2>() = rest.leftCols<2>() * path.f0.transpose();
    path.step.leftCols<2>() = rest.leftCols<2>() * (path.f1 - path.f0).transpose();
    paths.push_back(path);
  };
  add(0.88, 0.93, -0.06, 1.13, 1.08, 0.05);
  add(0.91, 1.07, 0.04, 1.12, 0.92, -0.03);
  add(0.6, 0.7, 0.1, 1.5, 1.4, -0.2);
  add(1.2, 1, 0, 1, 1.15, 0);
  add(0.8, 1, 0, 1, 0.85, 0);
  add(0.998, 0.997, -0.003, 1.003, 1.002, 0.002);
  Path bent = paths.back();
  const double edge = std::sqrt(2 * level.vertex_area.sum() / level.triangle_count());
  bent.step.setZero();
  for (Eigen::Index i = 0; i < rest.rows(); ++i) {
    const double z = edge * (1 + 0.3 * std::sin(static_cast<double>(7 * i + 1)));
    bent.from(i, 2) -= z, bent.step(i, 2) = 2 * z;
  }
  bent.height = 0.5 * bent.step.col(2).maxCoeff();
  paths.push_back(bent);
  return paths;
}

/// The energy [J] at a point of a path, and its slope by t [J].
struct Sample {
  double t, quantities[2];
  bool finite() const { return std::isfinite(quantities[0]) && std::isfinite(quantities[1]); }
};

Sample sample(const BoundEnergy& energy, const Path& path, double t) {
  const Positions x = path.from + t * path.step;
  Positions g = Positions::Zero(x.rows(), 3);
  const double value = add_gradient_of(energy, "that is checked", x, g);
  return {t, {value, g.cwiseProduct(path.step).sum()}};
}

/// What is left of the change of a quantity in an interval whose larger half is taken again and again, until
/// it is small. A continuous quantity changes as little as the interval is short.
std::pair<double, double> last_change(const BoundEnergy& energy, const Path& path, Sample a, Sample b,
                                      int quantity, double small) {
  const auto change = [&](const Sample& from, const Sample& to) {
    return std::abs(to.quantities[quantity] - from.quantities[quantity]);
  };
  for (int i = 0; i < halvings && change(a, b) > small; ++i) {
    const Sample middle = sample(energy, path, 0.5 * (a.t + b.t));
    if (!middle.finite()) return {0, a.t};
    (change(a, middle) > change(middle, b) ? b : a) = middle;
  }
  return {change(a, b), a.t};
}

}  // namespace

std::string jump_of(const BoundEnergy& energy, const Level& level) {
  const std::vector<Path> paths = paths_of(level);
  std::vector<std::vector<Sample>> samples;
  double largest[2] = {0, 0};
  for (const Path& path : paths) {
    auto& all = samples.emplace_back();
    for (int i = 0; i <= intervals; ++i) {
      all.push_back(sample(energy, path, static_cast<double>(i) / intervals));
      for (int k = 0; k < 2 && all.back().finite(); ++k)
        largest[k] = std::max(largest[k], std::abs(all.back().quantities[k]));
    }
  }
  for (int k = 0; k < 2; ++k)
    for (std::size_t p = 0; p < paths.size(); ++p)
      for (int i = 0; i < intervals; ++i) {
        const Sample &a = samples[p][i], &b = samples[p][i + 1];
        if (!a.finite() || !b.finite()) continue;
        const double small = least_jump * largest[k];
        const auto [change, t] = last_change(energy, paths[p], a, b, k, small);
        if (change > small)
          return std::string(k == 0 ? "the energy" : "the force") + " jumps by " +
                 general_text(100 * change / largest[k], 3) + " % of the largest on the way, " +
                 paths[p].place(t) +
                 (paths[p].exchanges_stretches(t)
                      ? "; s1 is the larger one, so that both change places there: let the law be a smooth "
                        "function that is symmetric in s1 and s2"
                      : "; let both branches of the law have the same energy and slope there");
      }
  return "";
}

std::string jump_of(const Energy& energy, const Material& material) {
  const Level level = checked_level();
  return jump_of(*bound_energy(energy, level, material), level);
}

}  // namespace drape
