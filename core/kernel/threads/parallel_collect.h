#pragma once

#include <vector>

#include "core/kernel/threads/parallel.h"

namespace drape {

/// What body(begin, end, found) appends to `found` on the pieces, in their order.
template <class T, class Body>
std::vector<T> parallel_collect(int size, int grain, const Body& body) {
  std::vector<std::vector<T>> pieces((size + grain - 1) / grain);
  parallel_for(size, grain, [&](int begin, int end) { body(begin, end, pieces[begin / grain]); });
  std::vector<T> all;
  for (const std::vector<T>& piece : pieces) all.insert(all.end(), piece.begin(), piece.end());
  return all;
}

}  // namespace drape
