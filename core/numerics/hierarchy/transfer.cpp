#include "core/numerics/hierarchy/transfer.h"

#include "core/kernel/threads/parallel.h"

namespace drape {

Transfer::Transfer(const ProlongationMatrix& weights)
    : prolong_(rows_of(weights)), restrict_(rows_of(ProlongationMatrix(weights.transpose()))) {}

Transfer::Rows Transfer::rows_of(const ProlongationMatrix& matrix) {
  Rows rows;
  rows.start.reserve(matrix.rows() + 1);
  rows.start.push_back(0);
  for (int r = 0; r < matrix.rows(); ++r) {
    for (ProlongationMatrix::InnerIterator it(matrix, r); it; ++it) {
      rows.column.push_back(static_cast<int>(it.col()));
      rows.weight.push_back(it.value());
    }
    rows.start.push_back(static_cast<int>(rows.column.size()));
  }
  return rows;
}

void Transfer::apply(const Rows& rows, const Positions& x, Positions& y) {
  const int n = static_cast<int>(rows.start.size()) - 1;
  y.resize(n, 3);
  const double* from = x.data();
  double* to = y.data();
  constexpr int rows_per_task = 2048;
  parallel_for(n, rows_per_task, [&](int begin, int end) {
    for (int r = begin; r < end; ++r) {
      double sx = 0, sy = 0, sz = 0;
      for (int k = rows.start[r]; k < rows.start[r + 1]; ++k) {
        const double w = rows.weight[k];
        const double* v = from + 3 * static_cast<std::size_t>(rows.column[k]);
        sx += w * v[0], sy += w * v[1], sz += w * v[2];
      }
      double* out = to + 3 * static_cast<std::size_t>(r);
      out[0] = sx, out[1] = sy, out[2] = sz;
    }
  });
}

}  // namespace drape
