#include "core/numerics/linear_algebra/galerkin.h"

#include "core/kernel/threads/parallel.h"

namespace drape {

GalerkinProduct::GalerkinProduct(const BlockPattern& fine, const ProlongationMatrix& weights) {
  using Weight = ProlongationMatrix::InnerIterator;
  const ProlongationMatrix children = weights.transpose();
  const AdjacencyList neighbours = fine.neighbours();
  coarse_ = BlockPattern::collect(static_cast<int>(weights.cols()), [&](int a, const auto& add) {
    for (Weight child(children, a); child; ++child)
      for (const int j : neighbours.row(static_cast<int>(child.col())))
        for (Weight parent(weights, j); parent; ++parent) add(static_cast<int>(parent.col()));
  });

  // In the order of the fine blocks.
  terms_ = Grouped<Term>::of(coarse_->blocks(), [&](const auto& add) {
    fine.for_each_block([&](int i, int j, int k) {
      for (Weight s(weights, i); s; ++s)
        for (Weight t(weights, j); t; ++t) {
          const int a = static_cast<int>(s.col()), b = static_cast<int>(t.col());
          const double w = s.value() * t.value();
          // The fine block stands for (i, j) and, transposed, for (j, i): coarse (a, b) receives the first,
          // (b, a) the second. Only the upper one is stored; the diagonal receives both.
          if (a <= b) add(coarse_->find(a, b), {k, w});
          if (i != j && b <= a) add(coarse_->find(b, a), {~k, w});
        }
    });
  });
}

void GalerkinProduct::form(const BlockMatrix& fine, BlockMatrix& coarse) const {
  parallel_for(coarse_->blocks(), 128, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) {
      double straight[9] = {}, turned[9] = {};
      for (const auto [source, w] : terms_.row(c)) {
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
