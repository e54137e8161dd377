#include "core/kernel/interfaces/topology.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace drape {
namespace {

void require_indices(const Triangles& triangles, int vertex_count) {
  for (int t = 0; t < triangles.rows(); ++t) {
    const auto v = triangles.row(t);
    if (v.minCoeff() < 0 || v.maxCoeff() >= vertex_count)
      throw std::runtime_error("topology: triangle " + std::to_string(t) + " has a vertex outside 0 … " +
                               std::to_string(vertex_count - 1));
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
      throw std::runtime_error("topology: triangle " + std::to_string(t) + " repeats a vertex");
  }
}

void number_edges(const Triangles& triangles, int vertex_count, bool is_manifold, Topology& topology) {
  const std::vector<int> order = half_edges_by_edge(triangles, vertex_count);
  std::vector<int> first(order.size());  // of each half-edge, the earliest on the same edge
  int edge_count = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same =
        i > 0 && HalfEdge::of(triangles, order[i - 1]).same_edge(HalfEdge::of(triangles, order[i]));
    first[order[i]] = same ? first[order[i - 1]] : order[i];
    edge_count += !same;
  }

  topology.edges.resize(edge_count, 2);
  topology.edge_triangles.resize(edge_count, 2);
  topology.triangle_edges.resize(triangles.rows(), 3);
  int* numbers = topology.triangle_edges.data();  // row-major: entry h belongs to half-edge h
  int next = 0;
  for (int h = 0; h < static_cast<int>(order.size()); ++h) {
    if (first[h] == h) {
      const HalfEdge side = HalfEdge::of(triangles, h);
      topology.edges.row(next) << side.smaller(), side.larger();
      topology.edge_triangles.row(next) << h / 3, -1;
      numbers[h] = next++;
      continue;
    }
    const int e = numbers[h] = numbers[first[h]];
    if (topology.edge_triangles(e, 1) == -1)
      topology.edge_triangles(e, 1) = h / 3;
    else if (is_manifold)
      throw std::runtime_error("topology: edge (" + std::to_string(topology.edges(e, 0)) + ", " +
                               std::to_string(topology.edges(e, 1)) + ") has more than two triangles");
  }
}

Topology make_topology(const Triangles& triangles, int vertex_count, bool is_manifold) {
  require_indices(triangles, vertex_count);
  Topology topology;
  number_edges(triangles, vertex_count, is_manifold, topology);

  topology.on_border.assign(vertex_count, 0);
  for (int e = 0; e < topology.edges.rows(); ++e) {
    if (topology.edge_triangles(e, 1) != -1) continue;
    topology.on_border[topology.edges(e, 0)] = 1;
    topology.on_border[topology.edges(e, 1)] = 1;
  }

  topology.vertex_triangles = AdjacencyList::of(vertex_count, [&](const auto& add) {
    for (int t = 0; t < triangles.rows(); ++t)
      for (int k = 0; k < 3; ++k) add(triangles(t, k), t);
  });
  AdjacencyList& neighbours = topology.vertex_vertices;
  neighbours = AdjacencyList::of(vertex_count, [&](const auto& add) {
    for (const auto& edge : topology.edges.rowwise()) add(edge[0], edge[1]), add(edge[1], edge[0]);
  });
  for (int v = 0; v < vertex_count; ++v) std::ranges::sort(neighbours.row(v));
  return topology;
}

}  // namespace

std::vector<int> half_edges_by_edge(const Triangles& triangles, int vertex_count) {
  const AdjacencyList by_larger = AdjacencyList::of(vertex_count, [&](const auto& add) {
    for (int h = 0; h < triangles.size(); ++h) add(HalfEdge::of(triangles, h).larger(), h);
  });
  const auto by_both = [&](const auto& add) {
    for (const int h : by_larger.items) add(HalfEdge::of(triangles, h).smaller(), h);
  };
  return AdjacencyList::of(vertex_count, by_both).items;
}

Topology Topology::of(const Triangles& triangles, int vertex_count) {
  return make_topology(triangles, vertex_count, true);
}

Topology Topology::of_any(const Triangles& triangles, int vertex_count) {
  return make_topology(triangles, vertex_count, false);
}

Eigen::Matrix<int, Eigen::Dynamic, 4, Eigen::RowMajor> Topology::hinges(const Triangles& triangles) const {
  const auto inner_count = (edge_triangles.col(1).array() != -1).count();
  Eigen::Matrix<int, Eigen::Dynamic, 4, Eigen::RowMajor> hinges(inner_count, 4);
  for (int e = 0, h = 0; e < edges.rows(); ++e) {
    if (edge_triangles(e, 1) == -1) continue;
    const int s = edge_triangles(e, 0), t = edge_triangles(e, 1);
    const int k = corner_opposite(e, s);
    hinges.row(h++) << triangles(s, (k + 1) % 3), triangles(s, (k + 2) % 3), triangles(s, k),
        triangles(t, corner_opposite(e, t));
  }
  return hinges;
}

}  // namespace drape
