#include "core/kernel/contact/box_tree.h"

#include <cassert>
#include <numeric>

#include "core/kernel/linear_algebra/parallel.h"

namespace drape {
namespace {

constexpr int groups_per_task = 512;

/// Orders the boxes by median splits; every aligned run of 8, 64, 512, … boxes becomes compact.
class MedianSplit {
 public:
  MedianSplit(const std::vector<Box>& boxes, std::vector<int>& order)
      : centres_(boxes.size()), order_(order) {
    for (std::size_t i = 0; i < boxes.size(); ++i)
      for (int k = 0; k < 3; ++k) centres_[i][k] = 0.5F * (boxes[i].lower[k] + boxes[i].upper[k]);
  }

  void sort(int begin, int end) {
    const int size = end - begin;
    if (size <= 8) return;
    int run = 8;
    while (size > 8LL * run) run *= 8;
    const int middle = begin + ((size + run - 1) / run + 1) / 2 * run;
    const int axis = longest_axis(begin, end);
    std::nth_element(
        order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int a, int b) {
          return centres_[a][axis] != centres_[b][axis] ? centres_[a][axis] < centres_[b][axis] : a < b;
        });
    sort(begin, middle);
    sort(middle, end);
  }

 private:
  int longest_axis(int begin, int end) const {
    Eigen::Array3f low = centres_[order_[begin]], high = low;
    for (int i = begin + 1; i < end; ++i) {
      low = low.min(centres_[order_[i]]);
      high = high.max(centres_[order_[i]]);
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    return axis;
  }

  std::vector<Eigen::Array3f> centres_;
  std::vector<int>& order_;
};

}  // namespace

BoxGroup::BoxGroup() {
  for (int k = 0; k < 8; ++k) set(k, Box());
}

void BoxGroup::set(int lane, const Box& box) {
  for (int k = 0; k < 3; ++k) {
    lower[k][lane] = box.lower[k];
    upper[k][lane] = box.upper[k];
  }
}

Box BoxGroup::box(int lane) const {
  Box b;
  for (int k = 0; k < 3; ++k) {
    b.lower[k] = lower[k][lane];
    b.upper[k] = upper[k][lane];
  }
  return b;
}

Box BoxGroup::bounds() const {
  Box b;
  for (int k = 0; k < 3; ++k) {
    b.lower[k] = *std::min_element(lower[k], lower[k] + 8);
    b.upper[k] = *std::max_element(upper[k], upper[k] + 8);
  }
  return b;
}

void BoxTree::build(const std::vector<Box>& boxes) {
  order_.resize(boxes.size());
  std::iota(order_.begin(), order_.end(), 0);
  MedianSplit(boxes, order_).sort(0, size());
  levels_.clear();
  for (int groups = leaf_groups(); groups > 0; groups = groups > 1 ? (groups + 7) / 8 : 0)
    levels_.emplace_back(groups);
  refit(boxes);
}

void BoxTree::refit(const std::vector<Box>& boxes) {
  assert(boxes.size() == order_.size());
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    std::vector<BoxGroup>& groups = levels_[level];
    const int below = level == 0 ? size() : static_cast<int>(levels_[level - 1].size());
    parallel_for(static_cast<int>(groups.size()), groups_per_task, [&](int begin, int end) {
      for (int i = 8 * begin; i < std::min(8 * end, below); ++i)
        groups[i / 8].set(i % 8, level == 0 ? boxes[order_[i]] : levels_[level - 1][i].bounds());
    });
  }
}

double BoxTree::surface_area_cost() const {
  std::vector<double> area;
  for (const std::vector<BoxGroup>& groups : levels_)
    area.push_back(parallel_sum(static_cast<int>(groups.size()), groups_per_task, [&](int begin, int end) {
      double sum = 0;
      for (int i = 8 * begin; i < 8 * end; ++i) sum += groups[i / 8].box(i % 8).half_area();
      return sum;
    }));
  return area.empty() ? 0 : std::accumulate(area.begin() + 1, area.end(), 0.0) / area[0];
}

}  // namespace drape
