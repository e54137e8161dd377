#include "core/numerics/stability/stability_test.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/numerics/linear_algebra/conjugate_gradients.h"
#include "core/numerics/stability/lowest_mode.h"
#include "core/numerics/step/rounding_floor.h"

namespace drape {
namespace {

/// Round-off of a factorisation, relative to the blocks of its vertices.
constexpr double relative_round_off = 4e-15;
/// Saddles are left below the first ratio; below the second one if at least this share of the cloth moves.
/// Others change nothing that can be seen: kinks of some fifty vertices (docs/results/stability.md).
constexpr double visible_ratio = -0.07, visible_ratio_of_large = -1e-4, large_extent = 0.05;
/// Modes that iterations find before they call an equilibrium stable.
constexpr int modes_without_factor = 4;
/// Tenfold shifts that are tried where the projected matrix does not factorise with the first.
constexpr int most_larger_shifts = 6;
/// A ratio is wanted to about a per cent, or to where it does not matter. Residuals bound the error of ratios
/// alone: the preconditioner is near the inverse of their second matrix.
constexpr ModeAccuracy ratio_accuracy{1e-2, 1e-5, 0.3, 200};
constexpr ModeAccuracy eigenvalue_accuracy{1e-2, 1e-6, std::numeric_limits<double>::infinity(), 60};

/// Numbers in [-1, 1) without any symmetry, the same ones every time (SplitMix64), 0 on fixed vertices.
Positions scattered_on(const std::vector<char>& fixed) {
  Positions x = Positions::Zero(static_cast<Eigen::Index>(fixed.size()), 3);
  std::uint64_t state = 0;
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    for (int c = 0; c < 3; ++c) {
      std::uint64_t z = (state += 0x9e3779b97f4a7c15U);
      z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
      z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
      if (!fixed[i]) x(i, c) = std::ldexp(static_cast<double>((z ^ (z >> 31)) >> 11), -52) - 1;
    }
  return x;
}

/// By how much the forces out of balance can lower eigenvalues of M⁻¹H [1/s²]: turning a body of size L under
/// them changes the energy by their product with L, over a moment of inertia of M L².
double feigned_eigenvalue(const Iterate& iterate) {
  const double force = iterate.force_residual() * iterate.residual_scale() * std::sqrt(iterate.free_count());
  return force / (iterate.model().masses().sum() * iterate.rest_diagonal());
}

/// What round-off may do to a vertex' stiffness [N/m]: that of the factorisation, and that of the forces
/// (rounding_bounds) over the shortest edge on which they act.
Eigen::VectorXd round_off(const Iterate& iterate, const BlockMatrix& matrix) {
  const Positions& x = iterate.x();
  Eigen::VectorXd shortest = Eigen::VectorXd::Constant(x.rows(), iterate.rest_diagonal());
  const Eigen::MatrixX3i& triangles = iterate.model().level().rest.triangles;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int i = triangles(t, k), j = triangles(t, (k + 1) % 3);
      const double edge = (x.row(i) - x.row(j)).norm();
      shortest[i] = std::min(shortest[i], edge);
      shortest[j] = std::min(shortest[j], edge);
    }
  Eigen::VectorXd result = rounding_bounds(matrix, x).cwiseQuotient(shortest);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double* block = matrix.block(matrix.pattern->row_start[i]);
    result[i] += relative_round_off * (std::abs(block[0]) + std::abs(block[4]) + std::abs(block[8]));
  }
  return result;
}

/// The participation ratio (Σ m_i |v_i|²)² / Σ m_i · Σ m_i |v_i|⁴: 1 for a translation, 1/n for a vertex.
double extent_of(const Positions& mode, const Eigen::VectorXd& masses) {
  const Eigen::ArrayXd squared = mode.rowwise().squaredNorm().array();
  const double sum = (masses.array() * squared).sum();
  return sum * sum / (masses.sum() * (masses.array() * squared.square()).sum());
}

bool is_visible(const Stability& s) {
  return s.curvature_ratio < (s.extent < large_extent ? visible_ratio : visible_ratio_of_large);
}

}  // namespace

StabilityTest test_stability(Iterate& iterate, FactorCache& factor, bool verdict_only) {
  StabilityTest test;
  if (iterate.free_count() == 0) return test;
  Stability& s = test.stability;
  const double neutral = feigned_eigenvalue(iterate);
  const Eigen::VectorXd& masses = iterate.model().masses();
  BlockMatrix hessian = factor.hessian(Projection::none);
  Eigen::VectorXd shift = neutral * masses + round_off(iterate, hessian);
  const auto faulty = [&](const std::string& fault) { return StabilityTest{fault, {}, {}, 0}; };
  if (!shift.allFinite()) return faulty("the Hessian is not finite");
  s.by_factorisation = !factor.prefers_cycle();
  const bool is_definite = s.by_factorisation && factor.prepare(hessian, shift);
  if (is_definite && verdict_only) return test;

  const BlockMatrix* projected = &factor.hessian(Projection::clamp);
  while (hessian.pattern != projected->pattern) {  // until neither has lost blocks of former contacts
    hessian = factor.hessian(Projection::none);
    projected = &factor.hessian(Projection::clamp);
  }
  for (int k = 0; !is_definite && !factor.prepare(*projected, shift); ++k) {
    if (k == most_larger_shifts) return faulty("the projected Hessian has no factor");
    shift *= 10;
  }

  const std::vector<char>& fixed = iterate.fixed();
  const LinearOperator h = [&](const Positions& x, Positions& y) { multiply_free(hessian, {}, fixed, x, y); };
  const LinearOperator shifted = [&](const Positions& x, Positions& y) {
    multiply_free(hessian, shift, fixed, x, y);
  };
  const LinearOperator b = [&](const Positions& x, Positions& y) {
    multiply_free(*projected, shift, fixed, x, y);
  };
  const LinearOperator m = [&](const Positions& x, Positions& y) {
    y.resize(x.rows(), 3);
    for_each_vertex(y, [&](int i) { y.row(i) = masses[i] * x.row(i); });
  };
  const LinearOperator inverse = [&](const Positions& x, Positions& y) { factor.precondition(x, y); };
  std::vector<Positions> starts(2);
  starts[1] = scattered_on(fixed);
  Positions weighted;
  m(starts[1], weighted);
  inverse(weighted, starts[0]);  // mostly the motions with little stiffness
  weighted.resize(0, 3);

  // H + S against H⁺ + S, whose quotients are at most 1: negative ones stand out however stiff the motion is.
  ModeAccuracy wanted = ratio_accuracy;
  if (!s.by_factorisation) wanted.modes = modes_without_factor;
  if (s.by_factorisation && !is_definite) wanted.below = 0;
  const LowestMode weakest = lowest_mode(shifted, b, inverse, starts, wanted);
  const bool is_stable = s.by_factorisation ? is_definite : weakest.value >= 0;
  const bool is_zero = std::abs(weakest.value) < -visible_ratio_of_large;  // but for round-off
  const bool is_found = is_definite || is_zero || (weakest.converged && is_stable == (weakest.value >= 0));
  if (!is_found)
    return faulty("no lowest eigenvalue was found in " + std::to_string(wanted.max_iterations) +
                  " iterations");
  if (is_stable && verdict_only) return test;
  starts[1] = weakest.vector;
  const LowestMode slowest = lowest_mode(h, m, inverse, starts, eigenvalue_accuracy);
  s.lowest_eigenvalue = slowest.value;
  const Positions* mode = &weakest.vector;
  const auto judge = [&](const Positions& v) {
    Positions hv, bv;
    h(v, hv);
    b(v, bv);
    s.curvature_ratio = inner_product(v, hv) / inner_product(v, bv);
    s.extent = extent_of(v, masses);
    s.verdict = is_stable ? Stability::stable : is_visible(s) ? Stability::unstable : Stability::marginal;
  };
  judge(weakest.vector);
  if (s.verdict == Stability::marginal) {  // a small kink may hide a large motion
    const Stability of_weakest = s;
    judge(slowest.vector);
    if (s.verdict == Stability::unstable)
      mode = &slowest.vector;
    else
      s = of_weakest;
  }
  test.mode = *mode / mode->cwiseAbs().maxCoeff();
  Positions product;
  h(test.mode, product);
  test.curvature = inner_product(test.mode, product);
  return test;
}

}  // namespace drape
