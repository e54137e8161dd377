#pragma once

#include "core/kernel/interfaces/prolongation_matrix.h"
#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// A prolongation prepared for repeated use: y = P x and g_c = Pᵀ g_f, threaded, without allocation and
/// bitwise reproducible for any number of threads.
class Transfer {
 public:
  explicit Transfer(const ProlongationMatrix& weights);

  /// fine = P coarse (n_f × 3); resizes `fine` if needed.
  void prolong(const Positions& coarse, Positions& fine) const { apply(prolong_, coarse, fine); }
  /// coarse = Pᵀ fine (n_c × 3).
  void restrict(const Positions& fine, Positions& coarse) const { apply(restrict_, fine, coarse); }

 private:
  static void apply(const ProlongationMatrix& matrix, const Positions& x, Positions& y);

  ProlongationMatrix prolong_, restrict_;
};

}  // namespace drape
