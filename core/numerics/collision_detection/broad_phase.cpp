#include "core/numerics/collision_detection/broad_phase.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/utility.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <utility>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/collision_detection/box_tree.h"

namespace drape {
namespace {

using IndexPairs = std::vector<std::pair<int, int>>;

/// Rows of ascending second indices, from lists of pairs in any order.
AdjacencyList rows_of(const std::vector<IndexPairs>& lists, int row_count, int column_count, long count) {
  if (count < column_count / 4) {  // to sort so few takes less time than to visit all columns
    AdjacencyList rows = AdjacencyList::of(row_count, [&](const auto& add) {
      for (const IndexPairs& list : lists)
        for (const auto& [i, j] : list) add(i, j);
    });
    for (int i = 0; i < row_count; ++i) std::ranges::sort(rows.row(i));
    return rows;
  }
  const AdjacencyList columns = AdjacencyList::of(column_count, [&](const auto& add) {
    for (const IndexPairs& list : lists)
      for (const auto& [i, j] : list) add(j, i);
  });
  return AdjacencyList::of(row_count, [&](const auto& add) {
    for (int j = 0; j < column_count; ++j)
      for (const int i : columns.row(j)) add(i, j);
  });
}

/// Downcasts `other` to the class Own.
template <class Own>
const Own& same_kind(const BroadPhase& other) {
  if (const Own* own = dynamic_cast<const Own*>(&other)) return *own;
  throw std::runtime_error("broad phase: boxes of two kinds of broad phase cannot be compared");
}

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

  bool overlaps(const BroadPhase& other, long limit, AdjacencyList& pairs) const override {
    const BoxTree& tree = same_kind<BvhBroadPhase>(other).tree_;
    const bool self = &other == this;
    const int runs = tree_.runs();
    std::vector<IndexPairs> lists((runs + runs_per_task - 1) / runs_per_task);
    std::atomic<long> count = 0;
    parallel_for(runs, runs_per_task, [&](int begin, int end) {
      IndexPairs& list = lists[begin / runs_per_task];
      std::size_t counted = 0;
      for (int run = begin; run < end && count.load(std::memory_order_relaxed) <= limit; ++run) {
        tree_.overlaps(
            tree, run,
            [&](int i, int j) { list.emplace_back(self ? std::min(i, j) : i, self ? std::max(i, j) : j); },
            [&] { return std::ssize(list) > limit; });
        count += static_cast<long>(list.size() - counted);
        counted = list.size();
      }
    });
    if (count > limit) return false;
    pairs = rows_of(lists, tree_.size(), tree.size(), count);
    return true;
  }

  std::unique_ptr<BroadPhase> copy() const override { return std::make_unique<BvhBroadPhase>(*this); }

 private:
  Stencils vertices_;
  BoxTree tree_;
  double cost_when_built_ = 0;
};

using Model = fcl::BVHModel<fcl::AABBd>;

class FclBroadPhase final : public BroadPhase {
 public:
  explicit FclBroadPhase(const Stencils& vertices) : vertices_(vertices) {}

  void update(const std::vector<Box>& boxes) override {
    // FCL refits triangles only: a triangle with the box's corners has the same bounds.
    std::vector<fcl::Vector3d> corners(3 * boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        corners[3 * i][k] = corners[3 * i + 2][k] = boxes[i].lower[k];
        corners[3 * i + 1][k] = boxes[i].upper[k];
      }
    if (boxes.size() == size_ && size_ > 0) {
      model_->beginReplaceModel();
      model_->replaceSubModel(corners);
      model_->endReplaceModel(true, true);
      return;
    }
    size_ = boxes.size();
    model_ = std::make_unique<Model>();
    if (size_ == 0) return;
    std::vector<fcl::Triangle> triangles;
    for (std::size_t i = 0; i < size_; ++i) triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    model_->beginModel(static_cast<int>(size_), static_cast<int>(3 * size_));
    model_->addSubModel(corners, triangles);
    model_->endModel();
  }

  bool overlaps(const BroadPhase& phase, long limit, AdjacencyList& pairs) const override {
    const auto& other = same_kind<FclBroadPhase>(phase);
    std::vector<IndexPairs> lists(1);
    if (size_ > 0 && other.size_ > 0 && !search(other, limit, lists[0])) return false;
    pairs = rows_of(lists, static_cast<int>(size_), static_cast<int>(other.size_), std::ssize(lists[0]));
    return true;
  }

  std::unique_ptr<BroadPhase> copy() const override { return std::make_unique<FclBroadPhase>(vertices_); }

 private:
  /// Traverses both trees top-down. A node against itself becomes its children against themselves and each
  /// other.
  bool search(const FclBroadPhase& other, long limit, IndexPairs& list) const {
    const bool self = &other == this;
    std::vector<std::pair<int, int>> stack{{0, 0}};
    while (!stack.empty()) {
      const auto [at, other_at] = stack.back();
      stack.pop_back();
      const auto &node = model_->getBV(at), &other_node = other.model_->getBV(other_at);
      if (self && at == other_at) {
        if (node.isLeaf()) continue;
        stack.emplace_back(node.leftChild(), node.leftChild());
        stack.emplace_back(node.rightChild(), node.rightChild());
        stack.emplace_back(node.leftChild(), node.rightChild());
      } else if (!node.bv.overlap(other_node.bv)) {
        continue;
      } else if (node.isLeaf() && other_node.isLeaf()) {
        const int i = node.primitiveId(), j = other_node.primitiveId();
        if (share_vertex(i, other, j)) continue;
        list.emplace_back(self ? std::min(i, j) : i, self ? std::max(i, j) : j);
        if (static_cast<long>(list.size()) > limit) return false;
      } else if (other_node.isLeaf() || (!node.isLeaf() && node.bv.size() > other_node.bv.size())) {
        stack.emplace_back(node.leftChild(), other_at);
        stack.emplace_back(node.rightChild(), other_at);
      } else {
        stack.emplace_back(at, other_node.leftChild());
        stack.emplace_back(at, other_node.rightChild());
      }
    }
    return true;
  }

  bool share_vertex(int i, const FclBroadPhase& other, int j) const {
    for (Eigen::Index a = 0; a < vertices_.cols(); ++a)
      for (Eigen::Index b = 0; b < other.vertices_.cols(); ++b)
        if (vertices_(i, a) == other.vertices_(j, b)) return true;
    return false;
  }

  Stencils vertices_;
  std::size_t size_ = 0;
  std::unique_ptr<Model> model_;
};

}  // namespace

std::unique_ptr<BroadPhase> make_broad_phase(BroadPhaseKind kind, const Stencils& vertices) {
  if (kind == BroadPhaseKind::fcl) return std::make_unique<FclBroadPhase>(vertices);
  return std::make_unique<BvhBroadPhase>(vertices);
}

std::shared_ptr<const BroadPhase> PoseTrees::of(const std::vector<Box>& boxes) {
  const std::lock_guard lock(busy_);
  const std::shared_ptr<BroadPhase> next = last_->copy();
  next->update(boxes);
  last_ = next;
  return next;
}

}  // namespace drape
