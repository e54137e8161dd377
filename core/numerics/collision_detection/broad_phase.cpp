#include "core/numerics/collision_detection/broad_phase.h"

#include <algorithm>
#include <atomic>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/collision_detection/box_tree.h"
#include "core/numerics/collision_detection/broad_phase_kinds.h"

namespace drape {
namespace {

/// The tree is rebuilt once its cost exceeds this multiple of the cost after the last build.
constexpr double rebuild_factor = 2;
constexpr int runs_per_task = 8;

class BvhBroadPhase final : public BroadPhase {
 public:
  explicit BvhBroadPhase(const Stencils& vertices) : vertices_(vertices) {}

  void update(const std::vector<Box>& boxes) override {
    if (static_cast<int>(boxes.size()) == tree_.size()) {
      tree_.refit(boxes);
      if (!(tree_.surface_area_cost() > rebuild_factor * cost_when_built_)) return;
    }
    tree_.build(boxes, vertices_);
    cost_when_built_ = tree_.surface_area_cost();
  }

  bool overlaps(long limit, AdjacencyList& pairs) const override {
    return collect(tree_.size(), limit, pairs, [this](int run, auto found) {
      tree_.overlaps(run, [&](int i, int j) { found(std::min(i, j), std::max(i, j)); });
    });
  }

  bool overlaps(const BroadPhase& other, long limit, AdjacencyList& pairs) const override {
    const BoxTree& tree = same_kind<BvhBroadPhase>(other).tree_;
    return collect(tree.size(), limit, pairs, [&](int run, auto found) { tree_.overlaps(tree, run, found); });
  }

 private:
  template <class Search>
  bool collect(int columns, long limit, AdjacencyList& pairs, const Search& search) const {
    const int runs = tree_.runs();
    std::vector<IndexPairs> lists((runs + runs_per_task - 1) / runs_per_task);
    std::atomic<long> count = 0;
    parallel_for(runs, runs_per_task, [&](int begin, int end) {
      IndexPairs& list = lists[begin / runs_per_task];
      std::size_t counted = 0;
      for (int run = begin; run < end && count.load(std::memory_order_relaxed) <= limit; ++run) {
        search(run, [&](int i, int j) { list.emplace_back(i, j); });
        count += static_cast<long>(list.size() - counted);
        counted = list.size();
      }
    });
    if (count > limit) return false;
    pairs = rows_of(lists, tree_.size(), columns);
    return true;
  }

  Stencils vertices_;
  BoxTree tree_;
  double cost_when_built_ = 0;
};

}  // namespace

AdjacencyList rows_of(const std::vector<IndexPairs>& lists, int row_count, int column_count) {
  const AdjacencyList columns = AdjacencyList::of(column_count, [&](const auto& add) {
    for (const IndexPairs& list : lists)
      for (const auto& [i, j] : list) add(j, i);
  });
  return AdjacencyList::of(row_count, [&](const auto& add) {
    for (int j = 0; j < column_count; ++j)
      for (const int* i = columns.begin(j); i != columns.end(j); ++i) add(*i, j);
  });
}

std::unique_ptr<BroadPhase> make_broad_phase(BroadPhaseKind kind, const Stencils& vertices) {
  if (kind == BroadPhaseKind::fcl) return make_fcl_broad_phase(vertices);
  return std::make_unique<BvhBroadPhase>(vertices);
}

}  // namespace drape
