#include "core/numerics/stability/lowest_mode.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "core/numerics/linear_algebra/conjugate_gradients.h"

namespace drape {
namespace {

/// Vectors of the subspace at most, and those that are kept when it is cut.
constexpr int most_vectors = 16, kept_vectors = 8;
/// A direction of which orthogonalisation leaves less than this is in the subspace already.
constexpr double negligible_direction = 1e-10;
constexpr int settled_iterations = 2;
/// Relative residual of a Ritz vector that counts as a mode: the next one is looked for.
constexpr double mode_residual = 1e-6;

/// A subspace with a B-orthonormal basis, and the products of its vectors.
class Subspace {
 public:
  Subspace(const LinearOperator& a, const LinearOperator& b) : a_(a), b_(b) {}

  /// Adds the part of w that is B-orthogonal to the subspace. Returns false if hardly any of it is.
  bool add(Positions w) {
    Positions bw;
    b_(w, bw);
    const double whole = std::sqrt(inner_product(w, bw));
    if (!(whole > 0) || !std::isfinite(whole)) return false;
    w /= whole;
    for (int pass = 0; pass < 2; ++pass)  // the second removes what round-off leaves
      for (std::size_t k = 0; k < v_.size(); ++k) w -= inner_product(w, bv_[k]) * v_[k];
    b_(w, bw);
    const double norm = std::sqrt(inner_product(w, bw));
    if (!(norm > negligible_direction)) return false;
    w /= norm;
    bw /= norm;
    Positions aw;
    a_(w, aw);
    const auto n = static_cast<Eigen::Index>(v_.size());
    projected_.conservativeResize(n + 1, n + 1);
    for (Eigen::Index k = 0; k < n; ++k) projected_(k, n) = projected_(n, k) = inner_product(v_[k], aw);
    projected_(n, n) = inner_product(w, aw);
    v_.push_back(std::move(w));
    av_.push_back(std::move(aw));
    bv_.push_back(std::move(bw));
    return true;
  }

  /// Changes to a basis of Ritz vectors, lowest first, and cuts a large subspace.
  void rotate() {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(projected_);
    const bool cut = static_cast<int>(v_.size()) >= most_vectors;
    const Eigen::Index count = cut ? kept_vectors : projected_.rows();
    const Eigen::MatrixXd rotation = eigen.eigenvectors().leftCols(count);
    for (auto* basis : {&v_, &av_, &bv_}) *basis = combined(*basis, rotation);
    projected_ = eigen.eigenvalues().head(count).asDiagonal();
  }

  /// Ritz values and vectors, after rotate().
  double value(std::size_t k) const {
    return projected_(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k));
  }
  const Positions& vector(std::size_t k) const { return v_[k]; }
  /// The first Ritz vector that is no mode yet, the last if all are. Where modes of value 0 move the body as
  /// a whole, the one that is looked for comes after them. Overwrites r with its A v − value B v.
  std::size_t first_unconverged(Positions& r) const {
    std::size_t k = 0;
    for (;; ++k) {
      r = av_[k] - value(k) * bv_[k];
      const double size = std::sqrt(inner_product(av_[k], av_[k])) +
                          std::abs(value(k)) * std::sqrt(inner_product(bv_[k], bv_[k]));
      if (k + 1 == v_.size() || k + 1 == kept_vectors ||
          std::sqrt(inner_product(r, r)) > mode_residual * size)
        return k;
    }
  }

 private:
  static std::vector<Positions> combined(const std::vector<Positions>& basis,
                                         const Eigen::MatrixXd& rotation) {
    std::vector<Positions> result;
    for (Eigen::Index j = 0; j < rotation.cols(); ++j) {
      Positions sum = rotation(0, j) * basis[0];
      for (std::size_t k = 1; k < basis.size(); ++k)
        sum += rotation(static_cast<Eigen::Index>(k), j) * basis[k];
      result.push_back(std::move(sum));
    }
    return result;
  }

  const LinearOperator &a_, &b_;
  std::vector<Positions> v_, av_, bv_;
  Eigen::MatrixXd projected_;  // vᵀAv
};

}  // namespace

LowestMode lowest_mode(const LinearOperator& a, const LinearOperator& b, const LinearOperator& precondition,
                       Positions start, const ModeAccuracy& accuracy) {
  LowestMode mode;
  Subspace subspace(a, b);
  if (!subspace.add(std::move(start))) return mode;
  int settled = 0;
  double lowest = std::numeric_limits<double>::infinity(), sought = lowest;
  const auto has_settled = [&](double value, double before) {
    return std::abs(value - before) <=
           std::max(accuracy.relative_change * std::abs(value), accuracy.negligible);
  };
  Positions r, w;
  for (int k = 0; k < accuracy.max_iterations && settled < settled_iterations; ++k) {
    const std::size_t next = subspace.first_unconverged(r);
    const double value = subspace.value(0), next_value = subspace.value(next);
    settled = has_settled(value, lowest) && has_settled(next_value, sought) ? settled + 1 : 0;
    lowest = value;
    sought = next_value;
    precondition(r, w);
    if (!subspace.add(std::move(w))) settled = settled_iterations;
    subspace.rotate();
  }
  mode.value = subspace.value(0);
  mode.converged = settled == settled_iterations;
  mode.vector = subspace.vector(0);
  return mode;
}

}  // namespace drape
