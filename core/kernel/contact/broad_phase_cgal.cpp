#include <CGAL/box_intersection_d.h>

#include "core/kernel/contact/broad_phase_kinds.h"

namespace drape {
namespace {

using NumberedBox = CGAL::Box_intersection_d::Box_with_info_d<float, 3, int>;

/// Thrown from the callback: the only way to stop CGAL's search.
struct TooMany {};

class CgalBroadPhase final : public BroadPhase {
 public:
  void update(const std::vector<Box>& boxes) override {
    size_ = static_cast<int>(boxes.size());
    boxes_.clear();
    for (int i = 0; i < size_; ++i) {
      Box box = boxes[i];
      boxes_.emplace_back(box.lower, box.upper, i);
    }
  }

  bool overlaps(long limit, AdjacencyList& pairs) const override {
    return collect(*this, limit, pairs, [&](auto found) {
      std::vector<NumberedBox> own = boxes_;  // CGAL reorders them
      CGAL::box_self_intersection_d(own.begin(), own.end(), [&](const NumberedBox& a, const NumberedBox& b) {
        found(std::min(a.info(), b.info()), std::max(a.info(), b.info()));
      });
    });
  }

  bool overlaps(const BroadPhase& other, long limit, AdjacencyList& pairs) const override {
    const CgalBroadPhase& same = same_kind<CgalBroadPhase>(other);
    return collect(same, limit, pairs, [&](auto found) {
      std::vector<NumberedBox> own = boxes_, others = same.boxes_;
      CGAL::box_intersection_d(
          own.begin(), own.end(), others.begin(), others.end(),
          [&](const NumberedBox& a, const NumberedBox& b) { found(a.info(), b.info()); });
    });
  }

 private:
  template <class Search>
  bool collect(const CgalBroadPhase& other, long limit, AdjacencyList& pairs, const Search& search) const {
    std::vector<IndexPairs> lists(1);
    try {
      search([&](int i, int j) {
        lists[0].emplace_back(i, j);
        if (static_cast<long>(lists[0].size()) > limit) throw TooMany();
      });
    } catch (const TooMany&) {
      return false;
    }
    pairs = rows_of(lists, size_, other.size_);
    return true;
  }

  int size_ = 0;
  std::vector<NumberedBox> boxes_;
};

}  // namespace

std::unique_ptr<BroadPhase> make_cgal_broad_phase() { return std::make_unique<CgalBroadPhase>(); }

}  // namespace drape
