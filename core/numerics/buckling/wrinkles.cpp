#include "core/numerics/buckling/wrinkles.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/numerics/buckling/buckling_membrane.h"
#include "core/numerics/elements/jet_functions.h"

namespace drape {
namespace {

using Eigen::Matrix2d, Eigen::Matrix3d, Eigen::Vector2d, Eigen::Vector3d;
using Wrinkles = Vector3d;  // q₁, q₂ and the angle of c₁ [rad]

constexpr double most = Buckling<double>::most;

Matrix3d second(const Jet<3, double>& w) {
  Matrix3d h;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) h(i, j) = w.second_by(i, j);
  return h;
}

/// W(G + A) + s tr A, with derivatives by q₁, q₂ and the angle; with N = 6 also by G's strains, which follow.
template <int N>
struct Relaxed {
  double value;
  Eigen::Matrix<double, N, 1> first;
  Eigen::Matrix<double, N, N> second;

  Relaxed(const StrainLaw& law, const Vector3d& g, const double* place, double s, const Wrinkles& p) {
    using J = Jet<N, double>;
    const auto strain = [&](int i) {
      if constexpr (N == 6)
        return J::variable(g[i], 3 + i);
      else
        return J(g[i]);
    };
    const J g11 = strain(0), g22 = strain(1), g12 = strain(2);
    const J q1 = J::variable(p[0], 0), q2 = J::variable(p[1], 1), angle = J::variable(p[2], 2);
    const J c11 = 1.0 + 2.0 * g11, c22 = 1.0 + 2.0 * g22, c12 = 2.0 * g12, x = cos(angle), y = sin(angle);
    // c₁ is (x, y) over its length in C⁻¹.
    const J square = (c11 * c22 - c12 * c12) / (x * x * c22 + y * y * c11 - 2.0 * x * y * c12);
    const J along = 0.5 * (q1 - q2) * square, all = 0.5 * (q2 - 1.0);
    const J a[] = {all * c11 + along * x * x, all * c22 + along * y * y, all * c12 + along * x * y};
    const J strains[] = {g11 + a[0], g22 + a[1], g12 + a[2]};
    const Jet<3, double> w =
        energy_of_one(law, {strains[0].value, strains[1].value, strains[2].value}, place);
    value = w.value + s * (a[0].value + a[1].value);
    Eigen::Matrix<double, 3, N> by;
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < N; ++i) by(k, i) = strains[k].first[i];
    first = by.transpose() * Vector3d(w.first);
    second = by.transpose() * drape::second(w) * by;
    for (int i = 0; i < N; ++i) {
      first[i] += s * (a[0].first[i] + a[1].first[i]);
      for (int j = 0; j < N; ++j) {
        second(i, j) += s * (a[0].second_by(i, j) + a[1].second_by(i, j));
        for (int k = 0; k < 3; ++k) second(i, j) += w.first[k] * strains[k].second_by(i, j);
      }
    }
  }

  /// Whether the energy may fall along q₁, q₂ and the angle: no bound is in the way, and the angle matters.
  std::array<bool, 3> free(const Wrinkles& p) const {
    const auto off_bounds = [&](int i) {
      return (p[i] > 1 || first[i] < 0) && (p[i] < most || first[i] > 0);
    };
    return {off_bounds(0), off_bounds(1), std::abs(p[0] - p[1]) > 1e-7};
  }
  /// The length of the forces on the free wrinkles [J].
  double unbalanced(const std::array<bool, 3>& free) const {
    double square = 0;
    for (int k = 0; k < 3; ++k) square += free[k] ? first[k] * first[k] : 0;
    return std::sqrt(square);
  }
  /// The matrix by the wrinkles, with the unit matrix's rows for those that are held.
  Matrix3d of_wrinkles(const std::array<bool, 3>& free) const {
    Matrix3d h = second.template topLeftCorner<3, 3>();
    for (int i = 0; i < 3; ++i)
      if (!free[i]) h.row(i).setZero(), h.col(i).setZero(), h(i, i) = 1;
    return h;
  }
};

/// The angle of the c₁ along which the energy falls most.
double falling_angle(const StrainLaw& law, const Vector3d& g, const double* place, double s) {
  const Jet<3, double> plain = energy_of_one(law, g, place);
  Matrix2d too_small, metric;  // S + s I and C
  too_small << plain.first[0] + s, plain.first[2] / 2, plain.first[2] / 2, plain.first[1] + s;
  metric << 1 + 2 * g[0], 2 * g[2], 2 * g[2], 1 + 2 * g[1];
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix2d> solver(too_small, metric.inverse());
  const Vector2d v = solver.eigenvectors().col(0);
  return std::atan2(v.y(), v.x());
}

Jet<3, double> jet_of(double value, const Vector3d& first, const Matrix3d& second) {
  Jet<3, double> w(value);
  for (int j = 0; j < 3; ++j) {
    w.first[j] = first[j];
    for (int i = 0; i <= j; ++i) w.second[w.index(i, j)] = second(i, j);
  }
  return w;
}

/// Newton's step of the free wrinkles; where the energy is not convex, by the absolute values of curvatures,
/// so that it goes downhill.
Wrinkles downhill_step(const Relaxed<3>& at, const std::array<bool, 3>& free) {
  Vector3d force = -at.first;
  for (int k = 0; k < 3; ++k)
    if (!free[k]) force[k] = 0;
  const Matrix3d h = at.of_wrinkles(free);
  Wrinkles step;
  if (const Eigen::LLT<Matrix3d> llt(h); llt.info() == Eigen::Success) {
    step = llt.solve(force);
  } else {
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(h);
    const Vector3d curvature = eigen.eigenvalues().cwiseAbs();
    const Matrix3d& v = eigen.eigenvectors();
    step = v * (v.transpose() * force).cwiseQuotient(curvature.cwiseMax(1e-12 * curvature.maxCoeff()));
  }
  constexpr double largest_turn = 0.3;  // [rad]
  if (std::abs(step[2]) > largest_turn) step *= largest_turn / std::abs(step[2]);
  return step;
}

}  // namespace

Jet<3, double> energy_of_one(const StrainLaw& law, const Vector3d& g, const double* place) {
  using P = Pack<native_pack_width>;
  const P all[] = {place[0], place[1], place[2], place[3]};
  const Jet<3, P> w = law({g[0], g[1], g[2]}, all);
  Jet<3, double> own(w.value[0]);
  for (int k = 0; k < 3; ++k) own.first[k] = w.first[k][0];
  for (int k = 0; k < 6; ++k) own.second[k] = w.second[k][0];
  return own;
}

Vector3d slack_strains(const StrainLaw& law, const double* place, double s) {
  Vector3d g = Vector3d::Zero();
  for (int i = 0; i < 50; ++i) {
    const Jet<3, double> w = energy_of_one(law, g, place);
    const Eigen::LLT<Matrix3d> llt(second(w));
    if (llt.info() != Eigen::Success) break;
    const Vector3d step = -llt.solve(Vector3d(w.first) + s * Vector3d(1, 1, 0));
    g += step;
    if (!(step.norm() < 1)) break;
    if (step.norm() < 1e-14) return g;
  }
  return Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
}

Jet<3, double> wrinkled(const StrainLaw& law, const Vector3d& g, const double* place, double s,
                        bool derivatives) {
  constexpr int max_iterations = 60;
  Wrinkles p(1, 1, falling_angle(law, g, place, s));
  Relaxed<3> now(law, g, place, s, p);
  for (int i = 0; i < max_iterations; ++i) {
    std::array<bool, 3> free = now.free(p);
    Wrinkles step = downhill_step(now, free);
    for (int k = 0; k < 2; ++k)  // not against a bound, which would turn it uphill
      if (free[k] && ((p[k] == 1 && step[k] < 0) || (p[k] == most && step[k] > 0))) {
        free[k] = false;
        step = downhill_step(now, free);
      }
    const double length = step.head<2>().cwiseAbs().maxCoeff() + std::abs(step[2] * (p[0] - p[1]));
    if (length < 1e-11) break;
    const double unbalanced = now.unbalanced(free);
    bool better = false;
    for (double fraction = 1; !better && fraction > 1e-6; fraction /= 2) {
      Wrinkles to = p + fraction * step;
      for (int k = 0; k < 2; ++k) to[k] = std::clamp(to[k], 1.0, most);
      const Relaxed<3> next(law, g, place, s, to);
      // At the end energies differ by round-off alone, of which a law may have much; then forces judge.
      const double noise = 1e-14 * (std::abs(now.value) + s);
      const bool alike = length < 1e-7 || next.value <= now.value + noise;
      better = next.value < now.value - noise || (alike && next.unbalanced(free) < 0.5 * unbalanced);
      if (better) p = to, now = next;
    }
    if (!better) break;
  }
  if (!derivatives) return now.value;
  const Relaxed<6> end(law, g, place, s, p);
  const std::array<bool, 3> free = end.free(p);
  Matrix3d coupling = end.second.topRightCorner<3, 3>();
  for (int k = 0; k < 3; ++k)
    if (!free[k]) coupling.row(k).setZero();
  const Matrix3d eliminated = coupling.transpose() * end.of_wrinkles(free).ldlt().solve(coupling);
  return jet_of(now.value, end.first.tail<3>(), end.second.bottomRightCorner<3, 3>() - eliminated);
}

}  // namespace drape
