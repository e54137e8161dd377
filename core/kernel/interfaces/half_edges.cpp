#include "core/kernel/interfaces/half_edges.h"

namespace drape {
namespace {

/// Stable counting sort of `items` by key(item) in 0 … key_count - 1.
template <class Key>
std::vector<int> sorted_by(const std::vector<int>& items, int key_count, Key key) {
  std::vector<int> start(key_count + 1, 0);
  for (int item : items) ++start[key(item) + 1];
  for (int k = 0; k < key_count; ++k) start[k + 1] += start[k];
  std::vector<int> sorted(items.size());
  for (int item : items) sorted[start[key(item)]++] = item;
  return sorted;
}

}  // namespace

std::vector<int> half_edges_by_edge(const Triangles& triangles, int vertex_count) {
  std::vector<int> numbers(3 * triangles.rows());
  for (std::size_t h = 0; h < numbers.size(); ++h) numbers[h] = static_cast<int>(h);
  const auto larger = [&](int h) { return HalfEdge::of(triangles, h).larger(); };
  const auto smaller = [&](int h) { return HalfEdge::of(triangles, h).smaller(); };
  return sorted_by(sorted_by(numbers, vertex_count, larger), vertex_count, smaller);
}

}  // namespace drape
