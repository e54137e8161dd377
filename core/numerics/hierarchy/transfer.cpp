#include "core/numerics/hierarchy/transfer.h"

#include "core/kernel/threads/parallel.h"

namespace drape {

Transfer::Transfer(const ProlongationMatrix& weights) : prolong_(weights), restrict_(weights.transpose()) {}

void Transfer::apply(const ProlongationMatrix& matrix, const Positions& x, Positions& y) {
  const int n = static_cast<int>(matrix.rows());
  y.resize(n, 3);
  const double* from = x.data();
  double* to = y.data();
  constexpr int rows_per_task = 2048;
  parallel_for(n, rows_per_task, [&](int begin, int end) {
    for (int r = begin; r < end; ++r) {
      double sx = 0, sy = 0, sz = 0;
      for (ProlongationMatrix::InnerIterator entry(matrix, r); entry; ++entry) {
        const double w = entry.value();
        const double* v = from + 3 * entry.col();
        sx += w * v[0], sy += w * v[1], sz += w * v[2];
      }
      double* out = to + 3 * static_cast<std::size_t>(r);
      out[0] = sx, out[1] = sy, out[2] = sz;
    }
  });
}

}  // namespace drape
