
#include <algorithm>
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

}  // namespace

/// Primitives a and b, a vertex and a triangle or two edges, that two triangles first < second represent. The
/// place orders the pairs of the same two.
struct SelfPairSearch::Pair {
  int first, second, place;
  PairKind kind;
  int a, b;
};

SelfPairSearch::SelfPairSearch(const Surface& cloth, BroadPhaseKind kind)
    : cloth_(cloth),
      vertices_(make_broad_phase(kind, vertices_alone(static_cast<int>(cloth.vertex_area.size())))),
      edges_(make_broad_phase(kind, cloth.edges)),
      triangles_(make_broad_phase(kind, cloth.triangles)) {}

template <PairKind kind>
std::array<int, 4> SelfPairSearch::vertices_of(int a, int b) const {
  if constexpr (kind == PairKind::edge_edge)
    return {cloth_.edges(a, 0), cloth_.edges(a, 1), cloth_.edges(b, 0), cloth_.edges(b, 1)};
  else
    return {a, cloth_.triangles(b, 0), cloth_.triangles(b, 1), cloth_.triangles(b, 2)};
}

template <PairKind kind>
SelfPairSearch::Pair SelfPairSearch::placed(int a, int b) const {
  if constexpr (kind == PairKind::edge_edge) {
    int p = cloth_.edge_corner[a], q = cloth_.edge_corner[b];
    if (p > q) {
      std::swap(p, q);
      std::swap(a, b);
    }
    return {p / 3, q / 3, 6 + 3 * (p % 3) + q % 3, kind, a, b};
  } else {
    const int t = cloth_.vertex_corner[a] / 3, k = cloth_.vertex_corner[a] % 3;
    return {std::min(t, b), std::max(t, b), t < b ? k : 3 + k, kind, a, b};
  }
}

template <PairKind kind>
void SelfPairSearch::collect(const LinearMotion& motion, long limit, std::vector<Pair>& pairs) const {
  const int count = static_cast<int>(rows_.start.size()) - 1;
  std::vector<std::vector<Pair>> lists((count + primitives_per_task - 1) / primitives_per_task);
  std::atomic<long> number = static_cast<long>(pairs.size());
  parallel_for(count, primitives_per_task, [&](int begin, int end) {
    std::vector<Pair>& list = lists[begin / primitives_per_task];
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
        if (within[lane] || may_come_within_dhat({vertices_of<kind>(a[lane], b[lane]), kind}, motion))
          list.push_back(placed<kind>(a[lane], b[lane]));
      }
      number += static_cast<long>(list.size() - before);
      lanes.size = 0;
    };
    for (int row = begin; row < end && number.load(std::memory_order_relaxed) <= limit; ++row)
      for (const int* other = rows_.begin(row); other != rows_.end(row); ++other) {
        a[lanes.size] = row;
        b[lanes.size] = *other;
        lanes.add(vertices_of<kind>(row, *other), motion);
        if (lanes.full()) test();
      }
    test();
  });
  for (const std::vector<Pair>& list : lists) pairs.insert(pairs.end(), list.begin(), list.end());
}

template <PairKind kind>
bool SelfPairSearch::find_kind(const BroadPhase& first, const BroadPhase& second, const LinearMotion& motion,
                               const PairLimits& limits, long& boxes, std::vector<Pair>& pairs) {
  if (!first.overlaps(second, limits.boxes - boxes, rows_)) return false;
  boxes += std::ssize(rows_.items);
  collect<kind>(motion, limits.primitives, pairs);
  return std::ssize(pairs) <= limits.primitives;
}

/// A counting sort by the first triangle, then one of each triangle's few pairs.
std::vector<SelfPairSearch::Pair> SelfPairSearch::in_order(const std::vector<Pair>& pairs) const {
  std::vector<int> end(cloth_.triangle_count() + 1, 0);
  for (const Pair& pair : pairs) ++end[pair.first + 1];
  for (std::size_t t = 1; t < end.size(); ++t) end[t] += end[t - 1];
  std::vector<Pair> sorted(pairs.size());
  for (const Pair& pair : pairs) sorted[end[pair.first]++] = pair;  // turns starts into ends
  for (int t = 0; t < cloth_.triangle_count(); ++t)
    std::sort(sorted.begin() + (t > 0 ? end[t - 1] : 0), sorted.begin() + end[t],
              [](const Pair& p, const Pair& q) {
                return std::tie(p.second, p.place) < std::tie(q.second, q.place);
              });
  return sorted;
}

bool SelfPairSearch::find(const LinearMotion& motion, double friction, const PairLimits& limits, long& boxes,
                          std::vector<ContactPair>& found) {
  // A translation of the whole cloth changes no distance within it.
  boxes_.update(cloth_, motion.x0, motion.x1.rowwise() - (motion.x1 - motion.x0).colwise().mean(),
                0.5 * motion.dhat, motion.x0.row(0));
  vertices_->update(boxes_.vertices);
  edges_->update(boxes_.edges);
  triangles_->update(boxes_.triangles);
  std::vector<Pair> pairs;
  if (!find_kind<PairKind::point_triangle>(*vertices_, *triangles_, motion, limits, boxes, pairs) ||
      !find_kind<PairKind::edge_edge>(*edges_, *edges_, motion, limits, boxes, pairs))
    return false;
  found.reserve(found.size() + pairs.size());
  for (const Pair& p : in_order(pairs)) {
    const bool edges = p.kind == PairKind::edge_edge;
    ContactPair& pair = found.emplace_back(edges ? edge_edge(cloth_, 0, p.a, cloth_, 0, p.b)
                                                 : vertex_triangle(0, p.a, cloth_, 0, p.b));
    pair.weight =
        edges ? 0.25 * std::min(cloth_.edge_area[p.a], cloth_.edge_area[p.b]) : 0.5 * cloth_.vertex_area[p.a];
    pair.dhat = motion.dhat;
    pair.friction = friction;
  }
  return true;
}

}  // namespace drape
