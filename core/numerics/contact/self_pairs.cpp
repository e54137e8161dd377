#include <algorithm>
#include <array>
#include <atomic>
#include <tuple>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/contact/candidates.h"
#include "core/numerics/contact/moving_pairs.h"

namespace drape {
namespace {

constexpr int primitives_per_task = 256;
constexpr int W = native_pack_width;

Stencils vertices_alone(int count) { return Eigen::VectorXi::LinSpaced(count, 0, count - 1); }

/// Primitives a and b, a vertex and a triangle or two edges, that two triangles first < second represent. The
/// place orders the pairs of the same two.
struct SelfPair {
  int first, second, place;
  PairKind kind;
  int a, b;
};

std::array<int, 4> vertices_of(PairKind kind, const Surface& cloth, int a, int b) {
  return kind == PairKind::edge_edge ? edge_edge(cloth, a, cloth, 0, b) : vertex_triangle(0, a, cloth, 0, b);
}

/// The pair of primitives a and b, with its place in the order.
template <PairKind kind>
SelfPair placed(const Surface& cloth, int a, int b) {
  if constexpr (kind == PairKind::edge_edge) {
    int p = cloth.edge_corner[a], q = cloth.edge_corner[b];
    if (p > q) {
      std::swap(p, q);
      std::swap(a, b);
    }
    return {p / 3, q / 3, 6 + 3 * (p % 3) + q % 3, kind, a, b};
  } else {
    const int t = cloth.vertex_corner[a] / 3, k = cloth.vertex_corner[a] % 3;
    return {std::min(t, b), std::max(t, b), t < b ? k : 3 + k, kind, a, b};
  }
}

/// Appends the pairs that may come within d̂, of primitives whose boxes overlap. Returns false once there are
/// more than `limit`.
template <PairKind kind>
bool collect_near(const Surface& cloth, const AdjacencyList& rows, const LinearMotion& motion, long limit,
                  std::vector<SelfPair>& pairs) {
  const int count = static_cast<int>(rows.start.size()) - 1;
  std::vector<std::vector<SelfPair>> lists((count + primitives_per_task - 1) / primitives_per_task);
  std::atomic<long> number = static_cast<long>(pairs.size());
  parallel_for(count, primitives_per_task, [&](int begin, int end) {
    std::vector<SelfPair>& list = lists[begin / primitives_per_task];
    PairLanes<W> lanes;
    int a[W], b[W];
    const auto test = [&] {
      if (lanes.size == 0) return;
      lanes.pad();
      const MovingPairs<kind, W> moving(lanes);
      const auto reach = moving.speed + motion.dhat;
      const auto beyond = moving.beyond(reach), within = moving.within(reach);
      const std::size_t before = list.size();
      for (int lane = 0; lane < lanes.size; ++lane) {
        if (beyond[lane]) continue;
        if (within[lane] || may_come_within_dhat({vertices_of(kind, cloth, a[lane], b[lane]), kind}, motion))
          list.push_back(placed<kind>(cloth, a[lane], b[lane]));
      }
      number += static_cast<long>(list.size() - before);
      lanes.size = 0;
    };
    for (int row = begin; row < end && number.load(std::memory_order_relaxed) <= limit; ++row)
      for (const int other : rows.row(row)) {
        a[lanes.size] = row;
        b[lanes.size] = other;
        lanes.add(vertices_of(kind, cloth, row, other), motion);
        if (lanes.full()) test();
      }
    test();
  });
  for (const std::vector<SelfPair>& list : lists) pairs.insert(pairs.end(), list.begin(), list.end());
  return std::ssize(pairs) <= limit;
}

/// By a counting sort by the first triangle, then one of each triangle's few pairs.
std::vector<SelfPair> in_order(const std::vector<SelfPair>& pairs, int triangle_count) {
  Grouped<SelfPair> rows = Grouped<SelfPair>::of(triangle_count, [&](const auto& add) {
    for (const SelfPair& pair : pairs) add(pair.first, pair);
  });
  for (int t = 0; t < triangle_count; ++t)
    std::ranges::sort(rows.row(t), [](const SelfPair& p, const SelfPair& q) {
      return std::tie(p.second, p.place) < std::tie(q.second, q.place);
    });
  return std::move(rows.items);
}

}  // namespace

SelfPairSearch::SelfPairSearch(const Surface& cloth, BroadPhaseKind kind)
    : cloth_(cloth),
      boxes_(cloth),
      edge_boxes_(cloth.edges.rows()),
      vertices_(make_broad_phase(kind, vertices_alone(cloth.vertex_count()))),
      edges_(make_broad_phase(kind, cloth.edges)),
      triangles_(make_broad_phase(kind, cloth.triangles)) {}

bool SelfPairSearch::find(const LinearMotion& motion, double friction, const PairLimits& limits, long& boxes,
                          std::vector<ContactPair>& found) {
  // A translation of the whole cloth changes no distance within it.
  boxes_.update(motion.x0, motion.x1.rowwise() - (motion.x1 - motion.x0).colwise().mean(), 0.5 * motion.dhat,
                motion.x0.row(0));
  parallel_for(static_cast<int>(edge_boxes_.size()), 4096, [&](int begin, int end) {
    for (int e = begin; e < end; ++e) edge_boxes_[e] = boxes_.edge(e);
  });
  vertices_->update(boxes_.vertices);
  edges_->update(edge_boxes_);
  triangles_->update(boxes_.triangles);
  std::vector<SelfPair> pairs;
  if (!vertices_->overlaps(*triangles_, limits.boxes - boxes, rows_)) return false;
  boxes += std::ssize(rows_.items);
  if (!collect_near<PairKind::point_triangle>(cloth_, rows_, motion, limits.primitives, pairs)) return false;
  if (!edges_->overlaps(*edges_, limits.boxes - boxes, rows_)) return false;
  boxes += std::ssize(rows_.items);
  if (!collect_near<PairKind::edge_edge>(cloth_, rows_, motion, limits.primitives, pairs)) return false;
  found.reserve(found.size() + pairs.size());
  for (const SelfPair& p : in_order(pairs, cloth_.triangle_count())) {
    const bool edges = p.kind == PairKind::edge_edge;
    ContactPair& pair = found.emplace_back(ContactPair{vertices_of(p.kind, cloth_, p.a, p.b), p.kind});
    if (edges)
      pair.mollifier =
          mollifier_threshold * cloth_.edge_length_squared[p.a] * cloth_.edge_length_squared[p.b];
    pair.weight =
        edges ? 0.25 * std::min(cloth_.edge_area[p.a], cloth_.edge_area[p.b]) : 0.5 * cloth_.vertex_area[p.a];
    pair.dhat = motion.dhat;
    pair.friction = friction;
  }
  return true;
}

}  // namespace drape
