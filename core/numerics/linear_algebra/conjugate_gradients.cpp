#include "core/numerics/linear_algebra/conjugate_gradients.h"

#include <cmath>

#include "core/kernel/threads/parallel.h"

namespace drape {
namespace {

constexpr int grain = 8192;  // vertices

/// Calls body(i) for each vertex.
template <class Body>
void for_each_vertex(const Positions& x, const Body& body) {
  parallel_for(static_cast<int>(x.rows()), grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) body(i);
  });
}

}  // namespace

double inner_product(const Positions& a, const Positions& b) {
  return parallel_sum(static_cast<int>(a.rows()), grain, [&](int begin, int end) {
    return a.middleRows(begin, end - begin).cwiseProduct(b.middleRows(begin, end - begin)).sum();
  });
}

ConjugateGradients::End ConjugateGradients::solve(const BlockMatrix& matrix, const Eigen::VectorXd& shift,
                                                  const std::vector<char>& fixed, const Positions& b,
                                                  const Precondition& precondition, const Accuracy& accuracy,
                                                  Positions& x) {
  r_ = b;
  for_each_vertex(r_, [&](int i) {
    if (fixed[i]) r_.row(i).setZero();
  });
  x.setZero(b.rows(), 3);
  double norm = std::sqrt(inner_product(r_, r_)), rz = 0;
  const double whole = norm;
  for (int k = 0;; ++k) {
    if (!std::isfinite(norm)) return End::not_converged;
    if (norm <= accuracy.tolerance * whole) return End::converged;
    if (k == accuracy.max_iterations)
      return norm <= accuracy.sufficient * whole ? End::converged : End::not_converged;
    precondition(r_, z_);
    const double next = inner_product(r_, z_);
    if (!(next > 0)) return std::isnan(next) ? End::not_converged : End::not_definite;
    if (k == 0)
      p_ = z_;
    else
      for_each_vertex(p_, [&, beta = next / rz](int i) { p_.row(i) = z_.row(i) + beta * p_.row(i); });
    rz = next;
    matrix.multiply(p_, ap_);
    for_each_vertex(p_, [&](int i) {
      if (fixed[i])
        ap_.row(i).setZero();
      else
        ap_.row(i) += shift[i] * p_.row(i);
    });
    const double curvature = inner_product(p_, ap_);
    if (!(curvature > 0)) return std::isnan(curvature) ? End::not_converged : End::not_definite;
    const double alpha = rz / curvature;
    for_each_vertex(x, [&](int i) {
      x.row(i) += alpha * p_.row(i);
      r_.row(i) -= alpha * ap_.row(i);
    });
    norm = std::sqrt(inner_product(r_, r_));
  }
}

}  // namespace drape
