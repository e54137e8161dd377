#pragma once

#include <vector>

#include "core/kernel/contact/box.h"

#ifdef __AVX__
#include <immintrin.h>
#endif

namespace drape {

/// Eight boxes in SIMD layout, compared with one instruction per bound.
struct alignas(32) BoxGroup {
  float lower[3][8];
  float upper[3][8];

  BoxGroup();
  void set(int lane, const Box& box);
  Box box(int lane) const;
  Box bounds() const;
  /// Bit k is set where box k overlaps.
  unsigned overlaps(const Box& box) const;
};

/// A complete bounding volume hierarchy with eight children per node. Median splits along the longest axis
/// assign boxes to leaves in build; refit only updates the bounds.
class BoxTree {
 public:
  /// Builds the tree for these boxes.
  void build(const std::vector<Box>& boxes);
  /// Updates the bounds to moved boxes, as many as it was built for.
  void refit(const std::vector<Box>& boxes);

  int size() const { return static_cast<int>(order_.size()); }
  int leaf_groups() const { return (size() + 7) / 8; }
  /// Surface area of the inner nodes over that of the leaves, the surface area heuristic's cost. It grows as
  /// neighbouring leaves move apart.
  double surface_area_cost() const;

  /// Calls found(i, j) once for each overlapping pair with one box in leaf group `group` and the other in
  /// that group or a later one.
  template <class Found>
  void overlaps(int group, const Found& found) const;
  /// Calls found(i, j) for each box i in leaf group `group` that overlaps box j of the other tree.
  template <class Found>
  void overlaps(const BoxTree& other, int group, const Found& found) const;

 private:
  template <class Found>
  void descend(const BoxTree& other, int group, int first_group, const Found& found) const;

  std::vector<int> order_;                     // box index of each leaf
  std::vector<std::vector<BoxGroup>> levels_;  // from the leaves up; the last has one group
};

inline unsigned BoxGroup::overlaps(const Box& box) const {
#ifdef __AVX__
  __m256 all = _mm256_castsi256_ps(_mm256_set1_epi32(-1));
  for (int k = 0; k < 3; ++k) {
    all =
        _mm256_and_ps(all, _mm256_cmp_ps(_mm256_set1_ps(box.lower[k]), _mm256_load_ps(upper[k]), _CMP_LE_OQ));
    all =
        _mm256_and_ps(all, _mm256_cmp_ps(_mm256_load_ps(lower[k]), _mm256_set1_ps(box.upper[k]), _CMP_LE_OQ));
  }
  return static_cast<unsigned>(_mm256_movemask_ps(all));
#else
  unsigned bits = 0;
  for (int i = 0; i < 8; ++i) bits |= static_cast<unsigned>(this->box(i).overlaps(box)) << i;
  return bits;
#endif
}

template <class Found>
void BoxTree::overlaps(int group, const Found& found) const {
  descend(*this, group, group, [&](int leaf, int other_leaf) {
    if (leaf < other_leaf) found(order_[leaf], order_[other_leaf]);
  });
}

template <class Found>
void BoxTree::overlaps(const BoxTree& other, int group, const Found& found) const {
  descend(other, group, 0, [&](int leaf, int other_leaf) { found(order_[leaf], other.order_[other_leaf]); });
}

template <class Found>
void BoxTree::descend(const BoxTree& other, int group, int first_group, const Found& found) const {
  if (other.order_.empty()) return;
  const BoxGroup& own = levels_[0][group];
  const Box bounds = own.bounds();
  struct Node {
    int level, group;
  } stack[8 * 11];  // 8^11 exceeds any int
  int depth = 0;
  stack[depth++] = {static_cast<int>(other.levels_.size()) - 1, 0};
  while (depth > 0) {
    const Node at = stack[--depth];
    const BoxGroup& boxes = other.levels_[at.level][at.group];
    if (at.level > 0) {
      for (unsigned bits = boxes.overlaps(bounds); bits != 0; bits &= bits - 1) {
        const int child = 8 * at.group + __builtin_ctz(bits);
        if (((child + 1LL) << 3 * (at.level - 1)) > first_group) stack[depth++] = {at.level - 1, child};
      }
      continue;
    }
    for (int k = 0; k < 8 && 8 * group + k < size(); ++k)
      for (unsigned bits = boxes.overlaps(own.box(k)); bits != 0; bits &= bits - 1)
        found(8 * group + k, 8 * at.group + __builtin_ctz(bits));
  }
}

}  // namespace drape
