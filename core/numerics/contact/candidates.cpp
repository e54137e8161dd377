#include "core/numerics/contact/candidates.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/contact/moving_pairs.h"

namespace drape {
namespace {

constexpr int rows_per_task = 256;

/// Calls found(v) for the vertices v that a's triangle s represents and whose boxes overlap b's triangle t.
template <class Found>
void represented_vertices(const SweptBoxes& a, int s, const SweptBoxes& b, int t, const Found& found) {
  for (int k = 0; k < 3; ++k)
    if (const int v = a.surface.triangles(s, k);
        a.surface.represents_vertex(s, k) && a.vertices[v].overlaps(b.triangles[t]))
      found(v);
}

/// Calls found(e, f) for the edges that the two triangles represent and whose boxes overlap.
template <class Found>
void represented_edges(const SweptBoxes& a, int s, const SweptBoxes& b, int t, const Found& found) {
  for (int k = 0; k < 3; ++k) {
    if (!a.surface.represents_edge(s, k)) continue;
    const int e = a.surface.triangle_edges(s, k);
    const Box& box = a.edges[e];
    if (!box.overlaps(b.triangles[t])) continue;
    for (int m = 0; m < 3; ++m)
      if (const int f = b.surface.triangle_edges(t, m);
          b.surface.represents_edge(t, m) && box.overlaps(b.edges[f]))
        found(e, f);
  }
}

/// Appends those that may come within d̂.
void append_near(const std::vector<ContactPair>& untested, const LinearMotion& motion,
                 std::vector<ContactPair>& list) {
  std::vector<char> near(untested.size());
  const auto mark = [&](const auto& moving, const int* indices, int size) {
    const auto reach = moving.speed + motion.dhat;
    const auto beyond = moving.beyond(reach), within = moving.within(reach);
    for (int lane = 0; lane < size; ++lane) {
      const int i = indices[lane];
      near[i] = within[lane] || (!beyond[lane] && may_come_within_dhat(untested[i], motion));
    }
  };
  for_each_pack(untested.data(), static_cast<int>(untested.size()), motion, mark);
  for (std::size_t i = 0; i < near.size(); ++i)
    if (near[i]) list.push_back(untested[i]);
}

/// Calls visit(s, t, untested) for every entry of the rows and concatenates the pairs that may come within d̂.
template <class Visit>
bool collect(const AdjacencyList& rows, const LinearMotion& motion, long limit,
             std::vector<ContactPair>& found, const Visit& visit) {
  const int count = static_cast<int>(rows.start.size()) - 1;
  std::vector<std::vector<ContactPair>> lists((count + rows_per_task - 1) / rows_per_task);
  std::atomic<long> number = std::ssize(found);
  parallel_for(count, rows_per_task, [&](int begin, int end) {
    if (number.load(std::memory_order_relaxed) > limit) return;
    std::vector<ContactPair> untested;
    for (int s = begin; s < end; ++s)
      for (const int t : rows.row(s)) visit(s, t, untested);
    std::vector<ContactPair>& list = lists[begin / rows_per_task];
    append_near(untested, motion, list);
    number += std::ssize(list);
  });
  if (number > limit) return false;
  found.reserve(number);
  for (const std::vector<ContactPair>& list : lists) found.insert(found.end(), list.begin(), list.end());
  return true;
}

/// The factor φ of the weight of a contact between the cloth's vertices, from the obstacle's sagitta there.
double protrusion_factor(double sagitta, double dhat) { return std::min(1.0, 8 * sagitta / dhat); }

}  // namespace

bool may_come_within_dhat(const ContactPair& pair, const LinearMotion& motion) {
  const PairPositions at = positions_of(pair, motion.x0, motion.obstacles0);
  PairPositions displacement = positions_of(pair, motion.x1, motion.obstacles1) - at;
  displacement.colwise() -= Eigen::Vector3d(displacement.rowwise().mean());
  double largest[2] = {0, 0};
  const int first_end = first_primitive_size(pair.kind);
  for (int k = 0; k < 4; ++k)
    largest[k >= first_end] = std::max(largest[k >= first_end], displacement.col(k).squaredNorm());
  // The factor covers round-off.
  const double reach = (motion.dhat + std::sqrt(largest[0]) + std::sqrt(largest[1])) * (1 + 1e-12);
  if (box_distance(pair.kind, at) > reach) return false;
  return connection(at, closest(pair.kind, at)).squaredNorm() <= reach * reach;
}

bool find_obstacle_pairs(const SweptBoxes& cloth_boxes, const ObstacleSurface& obstacles,
                         const SweptBoxes& obstacle_boxes, const AdjacencyList& rows,
                         const LinearMotion& motion, double friction, long limit,
                         std::vector<ContactPair>& found) {
  const Surface &cloth = cloth_boxes.surface, &other = obstacles.surface;
  const Dihedrals& dihedrals = obstacles.dihedrals;
  const auto first_other = static_cast<int>(motion.x0.rows());
  return collect(rows, motion, limit, found, [&](int s, int t, std::vector<ContactPair>& untested) {
    const auto add = [&](ContactPair pair, double weight) {
      pair.weight = weight;
      pair.dhat = motion.dhat;
      pair.obstacle = obstacles.body_of(other.triangles(t, 0));
      pair.friction = obstacles.friction_of(pair.obstacle, friction);
      untested.push_back(pair);
    };
    represented_vertices(cloth_boxes, s, obstacle_boxes, t, [&](int v) {
      ContactPair pair = vertex_triangle(0, v, other, first_other, t);
      pair.surface_triangle = t;
      add(pair, 0);
    });
    represented_vertices(obstacle_boxes, t, cloth_boxes, s, [&](int v) {
      // The side of an equilateral triangle of the same area.
      const double length = std::sqrt(4 / std::sqrt(3.0) * cloth.triangle_area[s]);
      add(vertex_triangle(first_other, v, cloth, 0, s),
          0.5 * std::min(other.vertex_area[v], cloth.triangle_area[s]) *
              protrusion_factor(dihedrals.vertex.sagitta(v, length), motion.dhat));
    });
    represented_edges(cloth_boxes, s, obstacle_boxes, t, [&](int e, int f) {
      const double length = std::sqrt(cloth.edge_length_squared[e]);
      ContactPair pair = edge_edge(cloth, 0, e, other, first_other, f);
      pair.at_rim = dihedrals.edge_is_rim[f] != 0;
      add(pair, 0.5 * std::min(cloth.edge_area[e], other.edge_area[f]) *
                    protrusion_factor(dihedrals.edge.sagitta(f, length), motion.dhat));
    });
  });
}

std::vector<VertexTriangleCandidate> surface_candidates(const std::vector<ContactPair>& pairs,
                                                        const Surface& cloth) {
  std::vector<VertexTriangleCandidate> all;
  for (const ContactPair& pair : pairs)
    if (pair.surface_triangle >= 0) all.push_back({pair.vertices[0], pair.surface_triangle});
  // The pairs of the vertices that one triangle represents are contiguous already.
  const auto row_of = [&](const VertexTriangleCandidate& c) { return cloth.vertex_corner[c.vertex] / 3; };
  for (auto begin = all.begin(), end = begin; begin != all.end(); begin = end) {
    end = std::find_if(begin, all.end(), [&](const auto& c) { return row_of(c) != row_of(*begin); });
    std::ranges::stable_sort(begin, end, {}, &VertexTriangleCandidate::vertex);
  }
  return all;
}

}  // namespace drape
