#pragma once

#include <vector>

#include "core/kernel/interfaces/topology.h"

namespace drape {

/// The first vertex of each connected component of a mesh, ascending.
inline std::vector<int> components(const Topology& topology) {
  std::vector<char> seen(topology.on_border.size(), 0);
  std::vector<int> first, open;
  for (int v = 0; v < static_cast<int>(seen.size()); ++v) {
    if (seen[v]) continue;
    first.push_back(v);
    open = {v};
    seen[v] = 1;
    while (!open.empty()) {
      const int from = open.back();
      open.pop_back();
      for (const int to : topology.vertex_vertices.row(from))
        if (!seen[to]) seen[to] = 1, open.push_back(to);
    }
  }
  return first;
}

}  // namespace drape
