#include "core/numerics/model/hessian_assembler.h"

#include <catch2/catch.hpp>

#include "tests/support/evaluate.h"
#include "tests/support/test_energies.h"

using namespace drape;

namespace {

/// Σ over pairs of ½ |x_a - x_b|²: its Hessian is known. A partner of -1 is the origin.
class PairSprings : public NoEnergy {
 public:
  explicit PairSprings(std::vector<std::pair<int, int>> pairs) : pairs_(std::move(pairs)) {}
  Stencils stencils() const override {
    Stencils s(pairs_.size(), 2);
    for (std::size_t e = 0; e < pairs_.size(); ++e) s.row(e) << pairs_[e].first, pairs_[e].second;
    return s;
  }
  void add_hessian(const Positions&, Projection, BlockSink& sink) const override {
    const double one[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, minus[9] = {-1, 0, 0, 0, -1, 0, 0, 0, -1};
    for (std::size_t e = 0; e < pairs_.size(); ++e) {
      sink.add(e, 0, 0, one);
      sink.add(e, 0, 1, minus);
      sink.add(e, 1, 1, one);
    }
  }

  Eigen::MatrixXd expected(int n) const {
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    for (const auto& [a, b] : pairs_)
      for (int c = 0; c < 3; ++c) {
        h(3 * a + c, 3 * a + c) += 1;
        if (b < 0) continue;
        h(3 * b + c, 3 * b + c) += 1;
        h(3 * a + c, 3 * b + c) -= 1;
        h(3 * b + c, 3 * a + c) -= 1;
      }
    return h;
  }

 private:
  std::vector<std::pair<int, int>> pairs_;
};

/// A chain of vertices, whose matrix is the smooth part.
struct ChainOfSprings {
  static constexpr int n = 12;
  PairSprings springs{[] {
    std::vector<std::pair<int, int>> pairs;
    for (int i = 0; i + 1 < n; ++i) pairs.emplace_back(i, i + 1);
    return pairs;
  }()};
  std::shared_ptr<const BlockPattern> pattern = BlockPattern::of(n, {springs.stencils()});
  BlockMatrix matrix{pattern};
  Positions x = Positions::Zero(n, 3);
  HessianAssembler assembler;

  const BlockMatrix& with(const PairSprings& transient,
                          const std::vector<const BoundEnergy*>& persistent = {}) {
    matrix.set_zero();
    const BlockSlots slots(*pattern, springs.stencils());
    BlockSink sink = slots.sink(matrix);
    springs.add_hessian(x, Projection::none, sink);
    return assembler.add(matrix, persistent, {&transient}, x, Projection::none);
  }
};

}  // namespace

TEST_CASE("elements whose blocks the pattern has are added in place", "[hessian_assembler]") {
  ChainOfSprings chain;
  const PairSprings near({{3, 4}, {7, 6}, {0, -1}});
  const BlockMatrix& sum = chain.with(near);
  CHECK(&sum == &chain.matrix);
  CHECK(dense(sum) == chain.springs.expected(ChainOfSprings::n) + near.expected(ChainOfSprings::n));
}

TEST_CASE("elements with missing blocks extend the pattern", "[hessian_assembler]") {
  ChainOfSprings chain;
  const PairSprings far({{11, 2}, {5, 0}, {3, 4}}), persistent({{8, 9}, {2, -1}});
  const Eigen::MatrixXd expected = chain.springs.expected(ChainOfSprings::n) +
                                   far.expected(ChainOfSprings::n) + persistent.expected(ChainOfSprings::n);
  CHECK(dense(chain.with(far, {&persistent})) == expected);
  CHECK(dense(chain.with(far, {&persistent})) == expected);  // independent of the last call
}

TEST_CASE("the pattern stays while contacts slide, and drops blocks that were long unused",
          "[hessian_assembler]") {
  ChainOfSprings chain;
  const auto first = chain.with(PairSprings({{2, 9}})).pattern;
  CHECK(first != chain.pattern);
  CHECK(first->find(2, 8) >= 0);  // padding: where contacts slide next
  CHECK(first->find(2, 6) < 0);
  CHECK(chain.with(PairSprings({{2, 8}})).pattern == first);
  CHECK(chain.with(PairSprings({})).pattern == first);
  for (int k = 0; k < 30; ++k) chain.with(PairSprings({}));
  const auto later = chain.with(PairSprings({{0, 5}})).pattern;
  CHECK(later != first);
  CHECK(later->find(0, 5) >= 0);
  CHECK(later->find(2, 9) < 0);
  const PairSprings again({{2, 9}, {0, 5}});
  CHECK(dense(chain.with(again)) ==
        chain.springs.expected(ChainOfSprings::n) + again.expected(ChainOfSprings::n));
}
