#include "core/numerics/multigrid/smoother.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <atomic>
#include <cstring>

#include "core/kernel/threads/parallel.h"

namespace drape {
namespace {

Float4 load(const float* p) {
  Float4 v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

/// Σ A_ik x_k over the blocks first … last - 1. The fourth number is of no meaning.
[[gnu::always_inline]] inline Float4 sum(const SmoothedMatrix& a, int first, int last, const Float4* x) {
  Float4 s0 = {}, s1 = {}, s2 = {};
  for (int k = first; k < last; ++k) {
    const float* b = a.block(static_cast<std::size_t>(k));
    const Float4 v = x[a.columns[static_cast<std::size_t>(k)]];
    s0 += load(b) * v[0];
    s1 += load(b + 3) * v[1];
    s2 += load(b + 6) * v[2];
  }
  return s0 + s1 + s2;
}

}  // namespace

bool SmoothedMatrix::finish() {
  parts_.resize(static_cast<std::size_t>(rows()));
  inverse_.resize(3 * static_cast<std::size_t>(rows()));
  std::atomic<bool> definite = true;
  parallel_for(rows(), piece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const auto place = [&](int column) {
        return static_cast<int>(
            std::lower_bound(columns.begin() + row_start[i], columns.begin() + row_start[i + 1], column) -
            columns.begin());
      };
      Row& row = parts_[i] = {place(begin), place(i), place(end), 0};
      for (int k = row_start[i]; k < row_start[i + 1]; ++k)
        if (k < row.own || k >= row.own_end) row.raise += Eigen::Map<const Eigen::Matrix3f>(block(k)).norm();
      Eigen::Matrix3d d = Eigen::Map<const Eigen::Matrix3f>(block(row.diagonal)).cast<double>();
      if (Eigen::LLT<Eigen::Matrix3d>(d).info() != Eigen::Success) definite = false;
      d.diagonal().array() += row.raise;
      const Eigen::Matrix3f inverse = d.inverse().cast<float>();
      for (int c = 0; c < 3; ++c)
        inverse_[3 * static_cast<std::size_t>(i) + c] =
            Float4{inverse(0, c), inverse(1, c), inverse(2, c), 0};
    }
  });
  return definite;
}

void SmoothedMatrix::presmooth(const std::vector<Float4>& b, std::vector<Float4>& x,
                               std::vector<Float4>& r) const {
  parallel_for(rows(), piece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      x[i] = solve_diagonal(i, b[i] - sum(*this, parts_[i].own, parts_[i].diagonal, x.data()));
  });
  // The sweep has solved each row with its own piece up to the raised diagonal: the rest is the residual.
  parallel_for(rows(), piece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      r[i] = parts_[i].raise * x[i] - sum(*this, row_start[i], parts_[i].own, x.data()) -
             sum(*this, parts_[i].diagonal + 1, row_start[i + 1], x.data());
  });
}

void SmoothedMatrix::postsmooth(const std::vector<Float4>& b, std::vector<Float4>& x,
                                std::vector<Float4>& old) const {
  old = x;
  parallel_for(rows(), piece, [&](int begin, int end) {
    for (int i = end - 1; i >= begin; --i) {
      const Row& row = parts_[i];
      x[i] += solve_diagonal(i, b[i] - sum(*this, row_start[i], row.own, old.data()) -
                                    sum(*this, row.own, row.own_end, x.data()) -
                                    sum(*this, row.own_end, row_start[i + 1], old.data()));
    }
  });
}

}  // namespace drape
