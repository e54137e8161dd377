#pragma once

#include <vector>

#include "core/kernel/interfaces/topology.h"
#include "core/numerics/mesh/disjoint_sets.h"

namespace drape {

/// The number of each vertex's connected component, in the order of their first vertices.
inline std::vector<int> component_numbers(const Topology& topology) {
  DisjointSets sets(static_cast<int>(topology.on_border.size()));
  for (const auto& edge : topology.edges.rowwise()) sets.unite(edge[0], edge[1]);
  return sets.numbered();
}

/// The first vertex of each connected component of a mesh, ascending.
inline std::vector<int> components(const Topology& topology) {
  const std::vector<int> number = component_numbers(topology);
  std::vector<int> first;
  for (int v = 0; v < static_cast<int>(number.size()); ++v)
    if (number[v] == static_cast<int>(first.size())) first.push_back(v);
  return first;
}

}  // namespace drape
