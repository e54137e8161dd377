#include "plugins/contact/ipc/candidates.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/contact/pair_geometry.h"
#include "core/numerics/parallel.h"

namespace drape {
namespace {

constexpr int grain = 256;  // rows a piece of work

/// Whether a pair can come within the range: as near as it is, less how far its sides move against each
/// other, the mean motion left out.
bool may_come_near(const ContactPair& pair, const Way& way) {
  const PairPositions at = positions_of(pair, way.x0, way.obstacles0);
  PairPositions move = positions_of(pair, way.x1, way.obstacles1) - at;
  move.colwise() -= Eigen::Vector3d(move.rowwise().mean());
  double largest[2] = {0, 0};
  const int first_end = first_side(pair.kind);
  for (int k = 0; k < 4; ++k)
    largest[k >= first_end] = std::max(largest[k >= first_end], move.col(k).squaredNorm());
  const double reach = (way.range + std::sqrt(largest[0]) + std::sqrt(largest[1])) * (1 + 1e-12);
  if (box_distance(pair.kind, at) > reach) return false;
  return connection(at, closest(pair.kind, at)).squaredNorm() <= reach * reach;
}

bool contains(const Triangles& triangles, int t, int v) {
  return triangles(t, 0) == v || triangles(t, 1) == v || triangles(t, 2) == v;
}

bool share_end(const Surface& surface, int e, int f) {
  const auto a = surface.edges.row(e), b = surface.edges.row(f);
  return a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1];
}

/// One of the two surfaces that meet.
struct Side {
  const Surface& surface;
  const SweptBoxes& boxes;
  int first_vertex;  ///< what its vertex 0 is called in pairs

  int vertex(int v) const { return first_vertex + v; }
};

ContactPair vertex_triangle(const Side& a, int v, const Side& b, int t) {
  const auto w = b.surface.triangles.row(t);
  return {{a.vertex(v), b.vertex(w[0]), b.vertex(w[1]), b.vertex(w[2])}, PairKind::point_triangle};
}

ContactPair edge_edge(const Side& a, int e, const Side& b, int f) {
  const auto v = a.surface.edges.row(e), w = b.surface.edges.row(f);
  ContactPair pair{{a.vertex(v[0]), a.vertex(v[1]), b.vertex(w[0]), b.vertex(w[1])}, PairKind::edge_edge};
  pair.mollifier = mollifier_share * a.surface.edge_length_squared[e] * b.surface.edge_length_squared[f];
  return pair;
}

/// Calls found(v) for the vertices v of a's triangle s whose boxes reach b's triangle t.
template <class Found>
void owned_vertices_near(const Side& a, int s, const Side& b, int t, const Found& found) {
  for (int k = 0; k < 3; ++k)
    if (const int v = a.surface.triangles(s, k);
        a.surface.owns_vertex(s, k) && a.boxes.vertices[v].overlaps(b.boxes.triangles[t]))
      found(v);
}

/// Calls found(e, f) for the edges of the two triangles whose boxes overlap.
template <class Found>
void owned_edges_near(const Side& a, int s, const Side& b, int t, const Found& found) {
  for (int k = 0; k < 3; ++k) {
    if (!a.surface.owns_edge(s, k)) continue;
    const int e = a.surface.triangle_edges(s, k);
    const Box box = a.boxes.edge(a.surface, e);
    if (!box.overlaps(b.boxes.triangles[t])) continue;
    for (int m = 0; m < 3; ++m)
      if (const int f = b.surface.triangle_edges(t, m);
          b.surface.owns_edge(t, m) && box.overlaps(b.boxes.edge(b.surface, f)))
        found(e, f);
  }
}

/// Calls at(s, t, list) for every entry of the rows and joins the lists.
template <class At>
bool collect(const AdjacencyList& rows, long limit, FoundPairs& found, const At& at) {
  const int count = static_cast<int>(rows.start.size()) - 1;
  std::vector<FoundPairs> lists((count + grain - 1) / grain);
  std::atomic<long> number = found.count();
  parallel_for(count, grain, [&](int begin, int end) {
    FoundPairs& list = lists[begin / grain];
    for (int s = begin; s < end && number.load(std::memory_order_relaxed) <= limit; ++s) {
      const long before = list.count();
      const auto first_near = static_cast<std::ptrdiff_t>(list.near.size());
      for (const int* t = rows.begin(s); t != rows.end(s); ++t) at(s, *t, list);
      std::stable_sort(list.near.begin() + first_near, list.near.end(),
                       [](const NearTriangle& a, const NearTriangle& b) { return a.vertex < b.vertex; });
      number += list.count() - before;
    }
  });
  if (number > limit) return false;
  found.pairs.reserve(number);
  for (const FoundPairs& list : lists) {
    found.pairs.insert(found.pairs.end(), list.pairs.begin(), list.pairs.end());
    found.near.insert(found.near.end(), list.near.begin(), list.near.end());
  }
  return true;
}

/// What is left of the weight of a contact between the cloth's vertices where the obstacle stands out by this
/// much.
double share(double sagitta, double range) { return std::min(1.0, 8 * sagitta / range); }

}  // namespace

bool find_self_pairs(const Surface& cloth, const SweptBoxes& boxes, const AdjacencyList& rows, const Way& way,
                     double friction, long limit, FoundPairs& found) {
  const Side side{cloth, boxes, 0};
  return collect(rows, limit, found, [&](int s, int t, FoundPairs& list) {
    const auto add = [&](ContactPair pair, double weight) {
      if (!may_come_near(pair, way)) return;
      pair.weight = weight;
      pair.friction = friction;
      list.pairs.push_back(pair);
    };
    for (const auto& [a, b] : {std::pair(s, t), std::pair(t, s)})
      owned_vertices_near(side, a, side, b, [&](int v) {
        if (!contains(cloth.triangles, b, v))
          add(vertex_triangle(side, v, side, b), 0.5 * cloth.vertex_area[v]);
      });
    owned_edges_near(side, s, side, t, [&](int e, int f) {
      if (!share_end(cloth, e, f))
        add(edge_edge(side, e, side, f), 0.25 * std::min(cloth.edge_area[e], cloth.edge_area[f]));
    });
  });
}

bool find_obstacle_pairs(const Surface& cloth, const SweptBoxes& boxes, const Obstacles& obstacles,
                         const SweptBoxes& obstacle_boxes, const AdjacencyList& rows, const Way& way,
                         double friction, long limit, FoundPairs& found) {
  const Surface& other = obstacles.surface;
  const Dihedrals& dihedrals = obstacles.dihedrals;
  const Side own{cloth, boxes, 0}, their{other, obstacle_boxes, static_cast<int>(way.x0.rows())};
  return collect(rows, limit, found, [&](int s, int t, FoundPairs& list) {
    const auto add = [&](ContactPair pair, double weight) {
      if (!may_come_near(pair, way)) return false;
      pair.weight = weight;
      pair.friction = obstacles.bodies[obstacles.body_of(other.triangles(t, 0))].friction.value_or(friction);
      list.pairs.push_back(pair);
      return true;
    };
    owned_vertices_near(own, s, their, t, [&](int v) {
      if (add(vertex_triangle(own, v, their, t), 0)) list.near.push_back({v, t});
    });
    owned_vertices_near(their, t, own, s, [&](int v) {
      const double length = std::sqrt(4 / std::sqrt(3.0) * cloth.triangle_area[s]);
      add(vertex_triangle(their, v, own, s), 0.5 * std::min(other.vertex_area[v], cloth.triangle_area[s]) *
                                                 share(dihedrals.vertex_sagitta(v, length), way.range));
    });
    owned_edges_near(own, s, their, t, [&](int e, int f) {
      const double length = std::sqrt(cloth.edge_length_squared[e]);
      add(edge_edge(own, e, their, f), 0.5 * std::min(cloth.edge_area[e], other.edge_area[f]) *
                                           share(dihedrals.edge_sagitta(f, length), way.range));
    });
  });
}

}  // namespace drape
