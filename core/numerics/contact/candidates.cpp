#include "core/numerics/contact/candidates.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/contact/moving_pairs.h"

namespace drape {
namespace {

constexpr int rows_per_task = 256, filtered_per_task = 4096, weights_per_task = 1024;

/// The primitives that a triangle of the cloth represents, with their boxes.
struct Represented {
  struct Primitive {
    int index;
    Box box;
  };
  Primitive vertices[3], edges[3];
  int vertex_count = 0, edge_count = 0;

  Represented(const SweptBoxes& cloth, int s) {
    for (int k = 0; k < 3; ++k) {
      const int v = cloth.surface.triangles(s, k), e = cloth.surface.triangle_edges(s, k);
      if (cloth.surface.represents_vertex(s, k)) vertices[vertex_count++] = {v, cloth.vertices[v]};
      if (cloth.surface.represents_edge(s, k)) edges[edge_count++] = {e, cloth.edge(e)};
    }
  }
};

/// Appends the pairs that the triangles s of the cloth and t of the obstacles represent and whose boxes
/// overlap. The obstacles' vertex 0 has the index `first` in pairs.
void append_overlapping(const SweptBoxes& cloth, int s, const Represented& own, const SweptBoxes& obstacles,
                        int t, int first, std::vector<ObstaclePair>& pairs) {
  const SurfaceTopology& other = obstacles.surface;
  for (int k = 0; k < own.vertex_count; ++k)
    if (const auto& [v, box] = own.vertices[k]; box.overlaps(obstacles.triangles[t]))
      pairs.push_back({vertex_triangle(0, v, other, first, t), PairKind::point_triangle, v, t});
  for (int k = 0; k < 3; ++k)
    if (const int v = other.triangles(t, k);
        other.represents_vertex(t, k) && obstacles.vertices[v].overlaps(cloth.triangles[s]))
      pairs.push_back({vertex_triangle(first, v, cloth.surface, 0, s), PairKind::point_triangle, s, v});
  for (int k = 0; k < own.edge_count; ++k) {
    const auto& [e, box] = own.edges[k];
    if (!box.overlaps(obstacles.triangles[t])) continue;
    for (int m = 0; m < 3; ++m)
      if (const int f = other.triangle_edges(t, m);
          other.represents_edge(t, m) && box.overlaps(obstacles.edge(f)))
        pairs.push_back({edge_edge(cloth.surface, e, other, first, f), PairKind::edge_edge, e, f});
  }
}

/// The pairs that may come within d̂, in their order.
std::vector<ObstaclePair> near_of(std::span<const ObstaclePair> untested, const LinearMotion& motion) {
  std::vector<char> near(untested.size());
  const auto mark = [&](const auto& moving, const int* indices, int size) {
    const auto reach = moving.speed + motion.dhat;
    const auto beyond = moving.beyond(reach), within = moving.within(reach);
    for (int lane = 0; lane < size; ++lane) {
      const ObstaclePair& pair = untested[indices[lane]];
      near[indices[lane]] =
          within[lane] || (!beyond[lane] && may_come_within_dhat({pair.vertices, pair.kind}, motion));
    }
  };
  for_each_pack(untested.data(), static_cast<int>(untested.size()), motion, mark);
  std::vector<ObstaclePair> found;
  for (std::size_t i = 0; i < near.size(); ++i)
    if (near[i]) found.push_back(untested[i]);
  return found;
}

/// Whether the boxes of a pair's primitives overlap. The obstacles' vertex 0 has the index `first` in pairs.
bool boxes_overlap(const ObstaclePair& pair, const SweptBoxes& cloth, const SweptBoxes& obstacles,
                   int first) {
  if (pair.kind == PairKind::edge_edge) return cloth.edge(pair.own).overlaps(obstacles.edge(pair.other));
  if (pair.vertices[0] < first) return cloth.vertices[pair.own].overlaps(obstacles.triangles[pair.other]);
  return obstacles.vertices[pair.other].overlaps(cloth.triangles[pair.own]);
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

bool find_obstacle_pairs(const SweptBoxes& cloth, const SweptBoxes& obstacles, const AdjacencyList& rows,
                         const LinearMotion& motion, long limit, std::vector<ObstaclePair>& found) {
  const int count = static_cast<int>(rows.start.size()) - 1, first = static_cast<int>(motion.x0.rows());
  std::vector<std::vector<ObstaclePair>> lists((count + rows_per_task - 1) / rows_per_task);
  std::atomic<long> number = 0;
  parallel_for(count, rows_per_task, [&](int begin, int end) {
    if (number.load(std::memory_order_relaxed) > limit) return;
    std::vector<ObstaclePair> untested;
    for (int s = begin; s < end; ++s) {
      if (rows.size(s) == 0) continue;
      const Represented own(cloth, s);
      for (const int t : rows.row(s)) append_overlapping(cloth, s, own, obstacles, t, first, untested);
    }
    lists[begin / rows_per_task] = near_of(untested, motion);
    number += std::ssize(lists[begin / rows_per_task]);
  });
  found.clear();
  if (number > limit) return false;
  for (const std::vector<ObstaclePair>& list : lists) found.insert(found.end(), list.begin(), list.end());
  return true;
}

std::vector<ObstaclePair> obstacle_pairs_among(const std::vector<ObstaclePair>& pairs,
                                               const SweptBoxes& cloth, const SweptBoxes& obstacles,
                                               const LinearMotion& motion) {
  const auto first = static_cast<int>(motion.x0.rows());
  const auto find = [&](int begin, int end, std::vector<ObstaclePair>& found) {
    found = near_of(std::span(pairs).subspan(begin, end - begin), motion);
    std::erase_if(found, [&](const ObstaclePair& p) { return !boxes_overlap(p, cloth, obstacles, first); });
  };
  return parallel_collect<ObstaclePair>(static_cast<int>(pairs.size()), filtered_per_task, find);
}

void append_contact_pairs(const std::vector<ObstaclePair>& pairs, const Surface& cloth,
                          const ObstacleSurface& obstacles, const Dihedrals& dihedrals, double dhat,
                          double friction, std::vector<ContactPair>& all) {
  const int first = cloth.vertex_count();
  const auto contact_pair = [&](const ObstaclePair& of) {
    ContactPair pair{of.vertices, of.kind};
    pair.dhat = dhat;
    pair.obstacle = obstacles.body_of(*std::ranges::max_element(of.vertices) - first);
    pair.friction = obstacles.friction_of(pair.obstacle, friction);
    if (of.kind == PairKind::edge_edge) {
      const auto ends = obstacles.topology->edges.row(of.other);
      const double square = cloth.edge_length_squared[of.own];
      const Bend bend = dihedrals.edge(of.other);
      pair.mollifier = mollifier_threshold * square *
                       (obstacles.vertices.row(ends[1]) - obstacles.vertices.row(ends[0])).squaredNorm();
      pair.at_rim = dihedrals.edge_is_rim(of.other);
      pair.weight = 0.5 * std::min(cloth.edge_area[of.own], bend.area) *
                    protrusion_factor(bend.sagitta(std::sqrt(square)), dhat);
    } else if (of.vertices[0] < first) {
      pair.surface_triangle = of.other;
    } else {
      // The side of an equilateral triangle of the same area.
      const double length = std::sqrt(4 / std::sqrt(3.0) * cloth.triangle_area[of.own]);
      const Bend bend = dihedrals.vertex(of.other);
      pair.weight = 0.5 * std::min(bend.area, cloth.triangle_area[of.own]) *
                    protrusion_factor(bend.sagitta(length), dhat);
    }
    return pair;
  };
  const std::size_t before = all.size();
  all.resize(before + pairs.size());
  parallel_for(static_cast<int>(pairs.size()), weights_per_task, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) all[before + i] = contact_pair(pairs[i]);
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
