#include "core/numerics/multigrid/smoother.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <atomic>
#include <cstring>
#include <utility>

#include "core/kernel/threads/parallel.h"

namespace drape {
namespace {

Float4 load(const float* p) {
  Float4 v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

/// Sums of blocks times vectors. The fourth number has no meaning.
struct Products {
  Float4 s0 = {}, s1 = {}, s2 = {};

  [[gnu::always_inline]] void add(const float* block, Float4 x) {
    s0 += load(block) * x[0];
    s1 += load(block + 3) * x[1];
    s2 += load(block + 6) * x[2];
  }
  Float4 total() const { return s0 + s1 + s2; }
};

}  // namespace

void SmoothedMatrix::set_pattern(AdjacencyList pattern) {
  pattern_ = std::move(pattern);
  const std::vector<int>&row_start = pattern_.start, &columns = pattern_.items;
  place_.resize(columns.size());
  stored_columns_.clear();
  stored_columns_.reserve(columns.size());
  const auto store = [&](Part& part, const auto& belongs) {
    part.resize(row_start.size());
    for (int i = 0; i < rows(); ++i) {
      part[i] = static_cast<int>(stored_columns_.size());
      for (int k = row_start[i]; k < row_start[i + 1]; ++k) {
        if (!belongs(i, columns[k])) continue;
        place_[k] = static_cast<int>(stored_columns_.size());
        stored_columns_.push_back(columns[k]);
      }
    }
    part.back() = static_cast<int>(stored_columns_.size());
  };
  store(below_, [](int i, int j) { return j < i && j / piece == i / piece; });
  store(above_, [](int i, int j) { return j > i && j / piece == i / piece; });
  store(elsewhere_, [](int i, int j) { return j / piece != i / piece; });
  Part diagonal;
  store(diagonal, [](int i, int j) { return j == i; });
  values_.resize(9 * columns.size() + 4);
}

bool SmoothedMatrix::finish() {
  raise_.resize(static_cast<std::size_t>(rows()));
  inverse_.resize(3 * static_cast<std::size_t>(rows()));
  std::atomic<bool> definite = true;
  const auto stored = [&](int k) {
    return Eigen::Map<const Eigen::Matrix3f>(values_.data() + 9 * static_cast<std::size_t>(k));
  };
  parallel_for(rows(), piece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      float raise = 0;
      for (int k = elsewhere_[i]; k < elsewhere_[i + 1]; ++k) raise += stored(k).norm();
      raise_[i] = raise;
      Eigen::Matrix3d d = stored(elsewhere_.back() + i).cast<double>();
      if (Eigen::LLT<Eigen::Matrix3d>(d).info() != Eigen::Success) definite = false;
      d.diagonal().array() += raise;
      const Eigen::Matrix3f inverse = d.inverse().cast<float>();
      for (int c = 0; c < 3; ++c)
        inverse_[3 * static_cast<std::size_t>(i) + c] =
            Float4{inverse(0, c), inverse(1, c), inverse(2, c), 0};
    }
  });
  return definite;
}

[[gnu::always_inline]] inline Float4 SmoothedMatrix::sum(const Part& part, int row,
                                                         const std::vector<Float4>& x) const {
  Products sum;
  for (int k = part[row]; k < part[row + 1]; ++k)
    sum.add(values_.data() + 9 * static_cast<std::size_t>(k), x[stored_columns_[k]]);
  return sum.total();
}

[[gnu::always_inline]] inline Float4 SmoothedMatrix::sum_backward(const Part& part, int row,
                                                                  const std::vector<Float4>& x) const {
  Products sum;
  for (int k = part[row + 1]; k-- > part[row];)
    sum.add(values_.data() + 9 * static_cast<std::size_t>(k), x[stored_columns_[k]]);
  return sum.total();
}

void SmoothedMatrix::presmooth(const std::vector<Float4>& b, std::vector<Float4>& x,
                               std::vector<Float4>& r) const {
  parallel_for(rows(), piece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) x[i] = solve_diagonal(i, b[i] - sum(below_, i, x));
  });
  // The sweep has solved each row with its own piece up to the raised diagonal: the rest is the residual.
  parallel_for(rows(), piece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) r[i] = raise_[i] * x[i] - sum(elsewhere_, i, x) - sum(above_, i, x);
  });
}

void SmoothedMatrix::postsmooth(const std::vector<Float4>& b, std::vector<Float4>& x,
                                std::vector<Float4>& old) const {
  old = x;
  parallel_for(rows(), piece, [&](int begin, int end) {
    for (int i = end - 1; i >= begin; --i)
      x[i] = solve_diagonal(i, b[i] + raise_[i] * x[i] - sum_backward(elsewhere_, i, old) -
                                   sum_backward(above_, i, x) - sum_backward(below_, i, x));
  });
}

}  // namespace drape
