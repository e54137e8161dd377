#include "core/numerics/collision_detection/box_tree.h"

#include <cassert>
#include <numeric>
#include <span>

#include "core/kernel/threads/parallel.h"

namespace drape {
namespace {

constexpr int groups_per_task = 512;

struct Centre {
  float at[3];
  int index;  ///< of its box
};

int longest_axis(std::span<const Centre> centres) {
  const auto place = [](const Centre& centre) { return Eigen::Array3f::Map(centre.at); };
  Eigen::Array3f low = place(centres[0]), high = low;
  for (const Centre& centre : centres) {
    low = low.min(place(centre));
    high = high.max(place(centre));
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  return axis;
}

/// Orders the boxes by median splits; every aligned run of 8, 64, 512, … boxes becomes compact.
void sort_by_medians(std::span<Centre> centres) {
  const int size = static_cast<int>(centres.size());
  if (size <= 8) return;
  int run = 8;
  while (size > 8LL * run) run *= 8;
  const int middle = ((size + run - 1) / run + 1) / 2 * run, axis = longest_axis(centres);
  std::nth_element(centres.begin(), centres.begin() + middle, centres.end(),
                   [axis](const Centre& a, const Centre& b) {
                     return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.index < b.index;
                   });
  sort_by_medians(centres.first(middle));
  sort_by_medians(centres.subspan(middle));
}

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

Box BoxGroup::bounds() const {
  Box b;
  for (int k = 0; k < 3; ++k) {
    b.lower[k] = *std::min_element(lower[k], lower[k] + 8);
    b.upper[k] = *std::max_element(upper[k], upper[k] + 8);
  }
  return b;
}

void BoxTree::build(const std::vector<Box>& boxes, const Stencils& vertices) {
  order_.resize(boxes.size());
  std::vector<Centre> centres(boxes.size());
  for (int i = 0; i < size(); ++i) {
    centres[i].index = i;
    for (int k = 0; k < 3; ++k) centres[i].at[k] = 0.5F * (boxes[i].lower[k] + boxes[i].upper[k]);
  }
  sort_by_medians(centres);
  for (int i = 0; i < size(); ++i) order_[i] = centres[i].index;
  levels_.clear();
  for (int groups = leaf_groups(); groups > 0; groups = groups > 1 ? (groups + 7) / 8 : 0)
    levels_.emplace_back(groups);
  vertex_count_ = static_cast<int>(vertices.cols());
  vertices_.assign(vertex_count_ > 0 ? leaf_groups() : 0, {});
  for (int leaf = 0; leaf < size(); ++leaf)
    for (int c = 0; c < vertex_count_; ++c)
      vertices_[leaf / 8].vertices[c][leaf % 8] = vertices(order_[leaf], c);
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
