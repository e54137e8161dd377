#include "plugins/contact/ipc/candidates.h"

#include <atomic>

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
bool collect(const AdjacencyList& rows, long limit, std::vector<ContactPair>& pairs, const At& at) {
  const int count = static_cast<int>(rows.start.size()) - 1;
  std::vector<std::vector<ContactPair>> lists((count + grain - 1) / grain);
  std::atomic<long> found = static_cast<long>(pairs.size());
  parallel_for(count, grain, [&](int begin, int end) {
    std::vector<ContactPair>& list = lists[begin / grain];
    for (int s = begin; s < end && found.load(std::memory_order_relaxed) <= limit; ++s) {
      const std::size_t before = list.size();
      for (const int* t = rows.begin(s); t != rows.end(s); ++t) at(s, *t, list);
      found += static_cast<long>(list.size() - before);
    }
  });
  if (found > limit) return false;
  pairs.reserve(found);
  for (const auto& list : lists) pairs.insert(pairs.end(), list.begin(), list.end());
  return true;
}

}  // namespace

bool find_self_pairs(const Surface& cloth, const SweptBoxes& boxes, const AdjacencyList& rows, const Way& way,
                     double friction, long limit, std::vector<ContactPair>& pairs) {
  const Side side{cloth, boxes, 0};
  return collect(rows, limit, pairs, [&](int s, int t, std::vector<ContactPair>& list) {
    const auto add = [&](ContactPair pair, double weight) {
      if (!may_come_near(pair, way)) return;
      pair.weight = weight;
      pair.friction = friction;
      list.push_back(pair);
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
                         double friction, long limit, std::vector<ContactPair>& pairs) {
  const Surface& other = obstacles.surface;
  const Side own{cloth, boxes, 0}, their{other, obstacle_boxes, static_cast<int>(way.x0.rows())};
  return collect(rows, limit, pairs, [&](int s, int t, std::vector<ContactPair>& list) {
    const auto add = [&](ContactPair pair, double weight) {
      if (!may_come_near(pair, way)) return;
      pair.weight = weight;
      pair.friction = obstacles.bodies[obstacles.body_of(other.triangles(t, 0))].friction.value_or(friction);
      list.push_back(pair);
    };
    owned_vertices_near(own, s, their, t,
                        [&](int v) { add(vertex_triangle(own, v, their, t), cloth.vertex_area[v]); });
    owned_vertices_near(their, t, own, s, [&](int v) {
      add(vertex_triangle(their, v, own, s), 0.5 * std::min(other.vertex_area[v], cloth.triangle_area[s]));
    });
    owned_edges_near(own, s, their, t, [&](int e, int f) {
      add(edge_edge(own, e, their, f), 0.5 * std::min(cloth.edge_area[e], other.edge_area[f]));
    });
  });
}

}  // namespace drape
