#pragma once

#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "core/numerics/linear_algebra/block_matrix.h"
#include "core/numerics/step/newton_parameters.h"

namespace drape {

/// The first multiple of the masses that is added to a matrix which is not positive definite [1/s²].
double first_mass_shift(const NewtonParameters& parameters);

/// Makes the Newton matrix positive definite: blends in the PSD projection of element Hessians (`psd_blend`),
/// then adds multiples of the masses.
class HessianModification {
 public:
  /// Fractions of the PSD projection that `adaptive` tries, in this order.
  static constexpr double blends[] = {0, 0.05, 0.1, 0.2, 0.4, 0.7, 1};
  static constexpr int blend_count = std::size(blends);

  explicit HessianModification(const NewtonParameters& parameters);

  /// Index of the fraction that worked last, or that is being tried.
  int blend() const { return blend_; }
  void set_blend(int blend) { blend_ = blend; }

  /// Returns the Hessian [N/m], with its element Hessians projected as asked. It stays valid until the next
  /// call.
  using Assemble = std::function<const BlockMatrix&(Projection)>;
  /// Factorises the matrix with `shift` [1/s²] times the masses added. Returns false if that is not positive
  /// definite.
  using Factorise = std::function<bool(const BlockMatrix&, double shift)>;

  /// Assembles and factorises with the least modification that suffices; after a full step a smaller blend
  /// than the last is tried first. Returns why no modification suffices; empty if one does.
  std::string factorise(const Assemble& assemble, const Factorise& factorise, const std::vector<char>& fixed,
                        bool after_full_step);

 private:
  int blend_ = blend_count - 1;
  Projection::Kind projection_;
  bool adaptive_;
  double first_shift_;  // [1/s²]
};

}  // namespace drape
