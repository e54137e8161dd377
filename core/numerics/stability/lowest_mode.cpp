#include "core/numerics/stability/lowest_mode.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/numerics/linear_algebra/conjugate_gradients.h"

namespace drape {
namespace {

/// Vectors of the subspace at most, and those that are kept when it is cut.
constexpr int most_vectors = 12, kept_vectors = 8;
/// A direction is in the subspace already if orthogonalisation leaves less of it.
constexpr double negligible_direction = 1e-10;
constexpr int settled_iterations = 2;
/// A Ritz vector with a smaller relative residual is a mode: the next one is looked for.
constexpr double mode_residual = 1e-6;

/// A subspace with a B-orthonormal basis. Products of its vectors are not stored: they would take twice the
/// memory of the basis.
class Subspace {
 public:
  Subspace(const LinearOperator& a, const LinearOperator& b) : a_(a), b_(b) {}

  /// Adds the part of w that is B-orthogonal to the subspace. Returns false if hardly any of it is.
  bool add(Positions w) {
    Positions product;
    b_(w, product);
    const double whole = std::sqrt(inner_product(w, product));
    if (!(whole > 0) || !std::isfinite(whole)) return false;
    w /= whole;
    product /= whole;
    for (int pass = 0; pass < 2; ++pass) {  // the second removes what round-off leaves
      for (const Positions& v : v_) w -= inner_product(v, product) * v;
      b_(w, product);
    }
    const double norm = std::sqrt(inner_product(w, product));
    if (!(norm > negligible_direction)) return false;
    w /= norm;
    a_(w, product);
    const auto n = static_cast<Eigen::Index>(v_.size());
    projected_.conservativeResize(n + 1, n + 1);
    for (Eigen::Index k = 0; k < n; ++k) projected_(k, n) = projected_(n, k) = inner_product(v_[k], product);
    projected_(n, n) = inner_product(w, product);
    v_.push_back(std::move(w));
    decompose();
    return true;
  }

  /// Replaces a large basis by the lowest Ritz vectors.
  void cut_if_large() {
    if (static_cast<int>(v_.size()) < most_vectors) return;
    for_each_vertex(v_[0], [&](int i) {  // in place, since twice the basis is much memory
      Eigen::Matrix<double, most_vectors, 3> rows;
      for (int k = 0; k < most_vectors; ++k) rows.row(k) = v_[k].row(i);
      for (int k = 0; k < kept_vectors; ++k) v_[k].row(i) = rotation_.col(k).transpose() * rows;
    });
    v_.resize(kept_vectors);
    projected_ = values_.head(kept_vectors).asDiagonal();
    decompose();
  }

  /// Ritz values, ascending, and their vectors.
  double value(Eigen::Index k) const { return values_[k]; }
  Positions vector(Eigen::Index k) const {
    Positions sum = rotation_(0, k) * v_[0];
    for (std::size_t j = 1; j < v_.size(); ++j) sum += rotation_(static_cast<Eigen::Index>(j), k) * v_[j];
    return sum;
  }
  /// The first Ritz vector from this one on that is not a mode yet, the last if all are: the mode that is
  /// looked for comes after those of value 0, which move the body as a whole. Overwrites r with its A v −
  /// value B v.
  Eigen::Index first_unconverged(Eigen::Index from, Positions& r) const {
    const Eigen::Index last = std::min<Eigen::Index>(values_.size(), kept_vectors) - 1;
    Positions bv;
    for (Eigen::Index k = std::min(from, last);; ++k) {
      const Positions v = vector(k);
      a_(v, r);
      b_(v, bv);
      bv *= value(k);
      const double size = std::sqrt(inner_product(r, r)) + std::sqrt(inner_product(bv, bv));
      r -= bv;
      if (k == last || std::sqrt(inner_product(r, r)) > mode_residual * size) return k;
    }
  }

 private:
  void decompose() {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(projected_);
    values_ = eigen.eigenvalues();
    rotation_ = eigen.eigenvectors();
  }

  const LinearOperator &a_, &b_;
  std::vector<Positions> v_;
  Eigen::MatrixXd projected_, rotation_;  // vᵀAv, and its eigenvectors
  Eigen::VectorXd values_;
};

}  // namespace

LowestMode lowest_mode(const LinearOperator& a, const LinearOperator& b, const LinearOperator& precondition,
                       const std::vector<Positions>& starts, const ModeAccuracy& accuracy) {
  LowestMode mode;
  Subspace subspace(a, b);
  bool has_any = false;
  for (const Positions& start : starts) has_any |= subspace.add(start);
  if (!has_any) return mode;
  int settled = 0;
  Eigen::Index from = 0;  // Ritz vectors before it have settled
  constexpr double unknown = std::numeric_limits<double>::infinity();
  double lowest = unknown, sought = unknown;
  const auto has_settled = [&](double value, double before) {
    return std::abs(value - before) <=
           std::max(accuracy.relative_change * std::abs(value), accuracy.negligible);
  };
  Positions r, w;
  for (int k = 0; k < accuracy.max_iterations; ++k) {
    const Eigen::Index next = subspace.first_unconverged(from, r);
    const double value = subspace.value(0), next_value = subspace.value(next);
    precondition(r, w);
    const double residual = std::sqrt(std::max(inner_product(r, w), 0.0));
    // The error of a Ritz value is about the square of its residual.
    const bool is_small =
        residual <= std::max(accuracy.residual * std::abs(next_value), std::sqrt(accuracy.negligible));
    settled = is_small && has_settled(value, lowest) && has_settled(next_value, sought) ? settled + 1 : 0;
    lowest = value;
    sought = next_value;
    if (settled == settled_iterations) {
      mode.converged = value < accuracy.below && from + 1 >= accuracy.modes;
      if (mode.converged || from + 1 == kept_vectors) break;
      ++from;
      settled = 0;
      sought = unknown;
    }
    if (!subspace.add(std::move(w))) break;
    subspace.cut_if_large();
  }
  mode.value = subspace.value(0);
  mode.vector = subspace.vector(0);
  return mode;
}

}  // namespace drape
