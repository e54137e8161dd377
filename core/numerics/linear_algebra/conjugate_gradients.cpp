#include "core/numerics/linear_algebra/conjugate_gradients.h"

#include <cmath>

namespace drape {

double inner_product(const Positions& a, const Positions& b) {
  return parallel_sum(static_cast<int>(a.rows()), vertices_at_once, [&](int begin, int end) {
    return a.middleRows(begin, end - begin).cwiseProduct(b.middleRows(begin, end - begin)).sum();
  });
}

void multiply_free(const BlockMatrix& matrix, const Eigen::VectorXd& shift, const std::vector<char>& fixed,
                   const Positions& x, Positions& y) {
  matrix.multiply(x, y);
  for_each_vertex(y, [&](int i) {
    if (fixed[i])
      y.row(i).setZero();
    else if (shift.size() > 0)
      y.row(i) += shift[i] * x.row(i);
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
    multiply_free(matrix, shift, fixed, p_, ap_);
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
