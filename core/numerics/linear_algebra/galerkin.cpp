#include "core/numerics/linear_algebra/galerkin.h"

#include <algorithm>

#include "core/kernel/threads/parallel.h"

namespace drape {

namespace {

/// Calls visit(coarse row a, coarse column b ≥ a, fine block, transposed, weight) for every term of
/// the product, in the order of the fine blocks.
template <class Visit>
void for_each_term(const BlockPattern& fine, const ProlongationMatrix& P, Visit visit) {
  const int* start = P.outerIndexPtr();
  const int* column = P.innerIndexPtr();
  const double* weight = P.valuePtr();
  for (int i = 0; i < fine.rows(); ++i)
    for (int k = fine.row_start[i]; k < fine.row_start[i + 1]; ++k) {
      const int j = fine.columns[k];
      for (int s = start[i]; s < start[i + 1]; ++s)
        for (int t = start[j]; t < start[j + 1]; ++t) {
          const int a = column[s], b = column[t];
          const double w = weight[s] * weight[t];
          // The fine block stands for (i, j) and, transposed, for (j, i): coarse (a, b) receives the
          // first, (b, a) the second. Only the upper one is stored; the diagonal receives both.
          if (a <= b) visit(a, b, k, false, w);
          if (i != j && b <= a) visit(b, a, k, true, w);
        }
    }
}

}  // namespace

GalerkinProduct::GalerkinProduct(const BlockPattern& fine, const ProlongationMatrix& weights) {
  const int n = static_cast<int>(weights.cols());
  ProlongationMatrix P = weights;
  P.makeCompressed();

  std::vector<std::vector<int>> columns(n);
  for (int a = 0; a < n; ++a) columns[a].push_back(a);
  // Drops duplicates whenever a row has doubled, which bounds the memory.
  std::vector<std::size_t> unique_size(n, 1);
  auto tidy = [&](int a) {
    auto& row = columns[a];
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    unique_size[a] = row.size();
  };
  for_each_term(fine, P, [&](int a, int b, int, bool, double) {
    if (columns[a].back() == b) return;
    columns[a].push_back(b);
    if (columns[a].size() > 2 * unique_size[a] + 64) tidy(a);
  });
  std::vector<int> row_start(1, 0), all;
  for (int a = 0; a < n; ++a) {
    tidy(a);
    all.insert(all.end(), columns[a].begin(), columns[a].end());
    row_start.push_back(static_cast<int>(all.size()));
  }
  columns.clear();
  coarse_ = std::make_shared<BlockPattern>(std::move(row_start), std::move(all));

  start_.assign(coarse_->blocks() + 1, 0);
  for_each_term(fine, P, [&](int a, int b, int, bool, double) { ++start_[coarse_->find(a, b) + 1]; });
  for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
  source_.resize(start_.back());
  weight_.resize(start_.back());
  std::vector<int> at(start_.begin(), start_.end() - 1);
  for_each_term(fine, P, [&](int a, int b, int block, bool transposed, double w) {
    const int slot = at[coarse_->find(a, b)]++;
    source_[slot] = transposed ? ~block : block;
    weight_[slot] = w;
  });
}

void GalerkinProduct::form(const BlockMatrix& fine, BlockMatrix& coarse) const {
  parallel_for(coarse_->blocks(), 128, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) {
      double straight[9] = {}, turned[9] = {};
      for (int k = start_[c]; k < start_[c + 1]; ++k) {
        const int source = source_[k];
        const double w = weight_[k];
        const double* b = fine.block(source >= 0 ? source : ~source);
        double* sum = source >= 0 ? straight : turned;
        for (int i = 0; i < 9; ++i) sum[i] += w * b[i];
      }
      double* out = coarse.block(c);
      for (int r = 0; r < 3; ++r)
        for (int q = 0; q < 3; ++q) out[3 * r + q] = straight[3 * r + q] + turned[3 * q + r];
    }
  });
}

}  // namespace drape
