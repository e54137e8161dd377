#include "core/numerics/model/hessian_assembler.h"

#include <catch2/catch.hpp>

#include "tests/support/evaluate.h"
#include "tests/support/test_energies.h"

using namespace drape;

namespace {

/// A chain of vertices, whose matrix is the smooth part.
struct ChainOfSprings {
  static constexpr int n = 12;
  PairSprings springs{[] {
    std::vector<PairSprings::Pair> pairs;
    for (int i = 0; i + 1 < n; ++i) pairs.push_back({i, i + 1});
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

/// The Hessian of unit springs between the chain's vertices.
Eigen::MatrixXd springs_matrix(const PairSprings& springs) {
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(3 * ChainOfSprings::n, 3 * ChainOfSprings::n);
  const auto add = [&](int a, int b, double k) { h.block<3, 3>(3 * a, 3 * b).diagonal().array() += k; };
  for (const auto& [a, b, k] : springs.pairs) {
    add(a, a, k);
    if (b >= 0) add(b, b, k), add(a, b, -k), add(b, a, -k);
  }
  return h;
}

}  // namespace

TEST_CASE("elements whose blocks the pattern has are added in place, others extend it") {
  ChainOfSprings chain;
  const PairSprings near({{3, 4}, {7, 6}, {0, -1}});
  const Eigen::MatrixXd own = springs_matrix(chain.springs);
  const BlockMatrix& sum = chain.with(near);
  CHECK(&sum == &chain.matrix);
  CHECK(dense(sum) == own + springs_matrix(near));

  const PairSprings far({{11, 2}, {5, 0}, {3, 4}}), persistent({{8, 9}, {2, -1}});
  for (int call = 0; call < 2; ++call)  // independent of the last one
    CHECK(dense(chain.with(far, {&persistent})) == own + springs_matrix(far) + springs_matrix(persistent));
}

TEST_CASE("the pattern stays while contacts slide, and drops blocks that were long unused") {
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
  CHECK(dense(chain.with(again)) == springs_matrix(chain.springs) + springs_matrix(again));
}
