#pragma once

#include <vector>

#include "core/numerics/collision_detection/box.h"
#include "core/numerics/linear_algebra/block_matrix.h"

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

/// Up to three vertices of each of eight primitives, in SIMD layout.
struct alignas(32) VertexGroup {
  int vertices[3][8];

  /// Bit k is set where `vertex` is one of the first `count` vertices of primitive k.
  unsigned containing(int vertex, int count) const;
};

/// A complete bounding volume hierarchy with eight children per node. Median splits along the longest axis
/// assign boxes to leaves in build; refit only updates the bounds.
class BoxTree {
 public:
  /// Builds the tree for these boxes. Row i of `vertices` has the vertices of the primitive in box i, at most
  /// three; without columns no two primitives share one.
  void build(const std::vector<Box>& boxes, const Stencils& vertices = {});
  /// Updates the bounds to moved boxes, as many as it was built for.
  void refit(const std::vector<Box>& boxes);

  int size() const { return static_cast<int>(order_.size()); }
  /// Number of runs of 64 boxes, neighbours in the tree, that a search is split into.
  int runs() const { return (size() + 63) / 64; }
  /// Surface area of the inner nodes over that of the leaves, the surface area heuristic's cost. It grows as
  /// neighbouring leaves move apart.
  double surface_area_cost() const;

  /// Calls found(i, j) for each box i of the run that overlaps box j of the other tree; of this tree, once
  /// for each pair with one box in the run and the other in that run or a later one. Leaves out pairs of
  /// primitives that share a vertex. Ends once ended(), which is asked after some thousand pairs at most.
  template <class Found, class Ended>
  void overlaps(const BoxTree& other, int run, const Found& found, const Ended& ended) const;

  /// Calls visit(i) for each box i with distance(box) ≤ reach. visit returns the reach from then on, so that
  /// a search for the nearest can shrink it. The distance of a box must be at least that of any box that
  /// contains it.
  template <class Distance, class Visit>
  void visit_near(double reach, const Distance& distance, const Visit& visit) const;

 private:
  template <bool self, class Found, class Ended>
  void search(const BoxTree& other, int run, const Found& found, const Ended& ended) const;
  template <bool self, class Found>
  void compare(const BoxTree& other, int level, int group, int other_group, const Found& found) const;

  int leaf_groups() const { return (size() + 7) / 8; }
  int height() const { return static_cast<int>(levels_.size()); }
  Box bounds(int level, int group) const {
    return level + 1 < height() ? levels_[level + 1][group / 8].box(group % 8)
                                : levels_[level][group].bounds();
  }
  /// Bit m is set where primitive m of the other's leaf group shares a vertex with primitive k of this one's.
  unsigned sharing(int group, int k, const BoxTree& other, int other_group) const;

  std::vector<int> order_;                     // box index of each leaf
  std::vector<std::vector<BoxGroup>> levels_;  // from the leaves up; the last has one group
  int vertex_count_ = 0;                       // of each primitive
  std::vector<VertexGroup> vertices_;          // of the leaves' primitives
};

inline Box BoxGroup::box(int lane) const {
  Box b;
  for (int k = 0; k < 3; ++k) {
    b.lower[k] = lower[k][lane];
    b.upper[k] = upper[k][lane];
  }
  return b;
}

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

inline unsigned VertexGroup::containing(int vertex, int count) const {
#ifdef __AVX2__
  const __m256i wanted = _mm256_set1_epi32(vertex);
  __m256i some = _mm256_setzero_si256();
  for (int c = 0; c < count; ++c)
    some = _mm256_or_si256(
        some, _mm256_cmpeq_epi32(wanted, _mm256_load_si256(reinterpret_cast<const __m256i*>(vertices[c]))));
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(some)));
#else
  unsigned bits = 0;
  for (int c = 0; c < count; ++c)
    for (int k = 0; k < 8; ++k) bits |= static_cast<unsigned>(vertices[c][k] == vertex) << k;
  return bits;
#endif
}

inline unsigned BoxTree::sharing(int group, int k, const BoxTree& other, int other_group) const {
  unsigned bits = 0;
  for (int c = 0; c < vertex_count_; ++c)
    bits |= other.vertices_[other_group].containing(vertices_[group].vertices[c][k], other.vertex_count_);
  return bits;
}

template <class Found, class Ended>
void BoxTree::overlaps(const BoxTree& other, int run, const Found& found, const Ended& ended) const {
  if (&other == this)
    search<true>(other, run, found, ended);
  else
    search<false>(other, run, found, ended);
}

template <class Distance, class Visit>
void BoxTree::visit_near(double reach, const Distance& distance, const Visit& visit) const {
  struct Node {
    double distance;
    int level, index;  // a group's, or at level -1 a box's
  } stack[8 * 12];
  int depth = 0;
  if (size() > 0) stack[depth++] = {-Box::infinity, height() - 1, 0};
  while (depth > 0) {
    const Node at = stack[--depth];
    if (!(at.distance <= reach)) continue;
    if (at.level < 0) {
      reach = visit(order_[at.index]);
      continue;
    }
    const int first = depth;
    for (int k = 0; k < 8; ++k)
      if (const Box box = levels_[at.level][at.index].box(k); !box.is_empty())
        stack[depth++] = {distance(box), at.level - 1, 8 * at.index + k};
    std::sort(stack + first, stack + depth,
              [](const Node& a, const Node& b) { return a.distance > b.distance; });
  }
}

/// Descends from the other's root to groups of the run's level.
template <bool self, class Found, class Ended>
void BoxTree::search(const BoxTree& other, int run, const Found& found, const Ended& ended) const {
  if (other.size() == 0) return;
  const int level = std::min({1, height() - 1, other.height() - 1});
  const int begin = level == 1 ? run : 8 * run,
            end = level == 1 ? run + 1 : std::min(8 * run + 8, leaf_groups());
  for (int group = begin; group < end; ++group) {
    const Box own = bounds(level, group);
    struct Node {
      int level, group;
    } stack[8 * 11];  // 8^11 exceeds any int
    int depth = 0;
    stack[depth++] = {other.height() - 1, 0};
    while (depth > 0 && !ended()) {
      const Node at = stack[--depth];
      if (at.level == level) {
        compare<self>(other, level, group, at.group, found);
        continue;
      }
      for (unsigned bits = other.levels_[at.level][at.group].overlaps(own); bits != 0; bits &= bits - 1) {
        const int child = 8 * at.group + __builtin_ctz(bits);
        if (!self || ((child + 1LL) << 3 * (at.level - 1 - level)) > group)
          stack[depth++] = {at.level - 1, child};
      }
    }
  }
}

/// Compares a group with one of the other tree, then those of their boxes' children that overlap.
template <bool self, class Found>
void BoxTree::compare(const BoxTree& other, int level, int group, int other_group, const Found& found) const {
  const BoxGroup &own = levels_[level][group], &boxes = other.levels_[level][other_group];
  const unsigned near = boxes.overlaps(bounds(level, group));
  if (near == 0) return;
  for (unsigned rest = own.overlaps(other.bounds(level, other_group)); rest != 0; rest &= rest - 1) {
    const int k = __builtin_ctz(rest);
    unsigned bits = near & boxes.overlaps(own.box(k));
    if (self && group == other_group) bits &= ~0U << (level == 0 ? k + 1 : k);
    if (bits != 0 && level == 0) bits &= ~sharing(group, k, other, other_group);
    for (; bits != 0; bits &= bits - 1) {
      const int i = 8 * group + k, j = 8 * other_group + __builtin_ctz(bits);
      if (level == 0)
        found(order_[i], other.order_[j]);
      else
        compare<self>(other, level - 1, i, j, found);
    }
  }
}

}  // namespace drape
