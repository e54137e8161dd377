#pragma once

#include "core/numerics/step/iterate.h"

namespace drape {

/// One implicit step from x^t: the energy F(x) + 1/(2h²) ‖x − x^t‖²_M of its inertia, and the forces. The
/// static form has no inertia.
class ImplicitStep {
 public:
  void begin(const Positions& x, int max_iterations) {
    origin_ = x;
    max_iterations_ = max_iterations;
  }
  int max_iterations() const { return max_iterations_; }

  /// Evaluates the step at the iterate; `inverse_h2` is 1/h² [1/s²], 0 for the static form.
  void evaluate(const Iterate& iterate, double inverse_h2);

  /// ∇F(x) + M (x − x^t) / h² there, n×3 [N], zero at fixed vertices.
  const Positions& gradient() const { return gradient_; }
  /// 1/(2h²) ‖x − x^t‖²_M there [J].
  double inertia() const { return inertia_; }

  /// The inertia at another x, for the h of the last evaluation [J].
  double inertia_at(const Positions& x, const Eigen::VectorXd& masses) const;
  /// Norm of the step's gradient over the free vertices at another x [N], whose ∇F(x) is `gradient`.
  double gradient_norm_at(const Positions& x, const Positions& gradient, const Iterate& iterate) const;

 private:
  int max_iterations_ = 1;
  Positions origin_;  // x^t
  Positions gradient_;
  double inertia_ = 0;
  double inverse_h2_ = 0;
};

}  // namespace drape
