#include "plugins/contact/ipc/rest_layers.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>

#include "core/kernel/files/message_text.h"
#include "core/kernel/threads/parallel.h"
#include "core/numerics/contact/candidates.h"
#include "core/numerics/mesh/disjoint_sets.h"

namespace drape::ipc {
namespace {

/// For each vertex some ten times the pairs of boxes of a large cloth with d̂ equal to its edge length, and
/// more of a small cloth.
constexpr long pairs_each = 250, pairs_of_any = 1'000'000;
/// Two primitives are neighbours if a path along the cloth connects them that stays within this distance, in
/// d̂, of the middle between their nearest points.
constexpr double neighbourhood = 2;
/// The barrier between layers does not end below this gap, in d̂: closer layers are pushed apart. Where the
/// neighbourhood of a fold ends, they then open by an angle of a sixteenth.
constexpr double smallest_reach = 0.25;
constexpr int pairs_per_task = 4096;

std::vector<ContactPair> pairs_within_dhat(const Surface& cloth, const Positions& rest, double dhat) {
  const Positions none;
  std::vector<ContactPair> found;
  long boxes = 0;
  const long most = pairs_of_any + pairs_each * rest.rows();
  const PairLimits limits{most, std::numeric_limits<long>::max()};
  if (!SelfPairSearch(cloth, BroadPhaseKind::bvh)
           .find({rest, rest, dhat, none, none}, 0, limits, boxes, found))
    throw std::runtime_error("contact \"ipc\": more than " + std::to_string(most) +
                             " pairs of the resting cloth's vertices, edges and triangles are within "
                             "\"dhat\" of each other; lower it to half the length of an edge, or take a mesh "
                             "whose triangles do not crowd");
  return found;
}

/// Searches for paths along the resting cloth from one primitive to another.
class PathSearch {
 public:
  PathSearch(const Level& level, double radius)
      : level_(level),
        radius_(radius),
        low_(level.rest.vertices.colwise().minCoeff()),
        high_(level.rest.vertices.colwise().maxCoeff()),
        part_(0.5 * (high_ - low_).norm() <= radius ? parts_of(level) : std::vector<int>()),
        visited_by_(level.triangle_count(), -1) {}

  /// Whether a path connects the pair's primitives within the radius of `centre`; `goal` is in the second.
  bool connects(const ContactPair& pair, const Eigen::Vector3d& centre, const Eigen::Vector3d& goal) {
    // Where the whole cloth is within the radius, every path is. A search would visit it all, for each pair.
    if ((centre - low_).cwiseAbs().cwiseMax((high_ - centre).cwiseAbs()).norm() <= radius_)
      return share_a_part(pair);
    ++search_;
    open_.clear();
    for (const int t : around(pair.vertices[0]))
      if (begins(pair, t)) open(t);
    while (!open_.empty()) {
      const int t = open_.back();
      open_.pop_back();
      if (ends(pair, t)) return true;
      // The neighbour nearest to the goal is opened last and so visited first: nearly a straight walk.
      const auto sides = level_.topology.triangle_edges.row(t);
      std::array<int, 3> edges = {sides[0], sides[1], sides[2]};
      std::ranges::sort(edges, std::ranges::greater(), [&](int e) { return distance(e, goal); });
      for (const int e : edges) {
        if (distance(e, centre) > radius_) continue;
        for (const int neighbour : {0, 1})
          if (const int s = level_.topology.edge_triangles(e, neighbour); s >= 0) open(s);
      }
    }
    return false;
  }

 private:
  std::span<const int> around(int v) const { return level_.topology.vertex_triangles.row(v); }
  /// Whether a path from the pair's first primitive begins in triangle t, and whether one ends there.
  bool begins(const ContactPair& pair, int t) const {
    return pair.kind == PairKind::point_triangle || has(t, pair.vertices[1]);
  }
  bool ends(const ContactPair& pair, int t) const {
    bool reached = true;
    for (int k = first_primitive_size(pair.kind); k < 4; ++k) reached = reached && has(t, pair.vertices[k]);
    return reached;
  }
  bool share_a_part(const ContactPair& pair) const {
    for (const int t : around(pair.vertices[0]))
      for (const int s : around(pair.vertices[3]))
        if (part_[t] == part_[s] && begins(pair, t) && ends(pair, s)) return true;
    return false;
  }
  /// For each triangle a number of those that edges connect with it.
  static std::vector<int> parts_of(const Level& level) {
    DisjointSets sets(level.triangle_count());
    for (const auto& sides : level.topology.edge_triangles.rowwise())
      if (sides.minCoeff() >= 0) sets.unite(sides[0], sides[1]);
    std::vector<int> part(level.triangle_count());
    for (std::size_t t = 0; t < part.size(); ++t) part[t] = sets.find(static_cast<int>(t));
    return part;
  }
  bool has(int t, int v) const { return (level_.rest.triangles.row(t).array() == v).any(); }
  void open(int t) {
    if (visited_by_[t] == search_) return;
    visited_by_[t] = search_;
    open_.push_back(t);
  }
  double distance(int e, const Eigen::Vector3d& centre) const {
    const Eigen::Vector3d a = level_.rest.vertices.row(level_.topology.edges(e, 0)),
                          b = level_.rest.vertices.row(level_.topology.edges(e, 1));
    return (a + nearest_on_segment(b - a, centre - a) * (b - a) - centre).norm();
  }

  const Level& level_;
  double radius_;
  Eigen::Vector3d low_, high_;   // the corners of the cloth's box
  std::vector<int> part_;        // empty where no pair has the whole cloth within the radius
  std::vector<int> visited_by_;  // the last search that opened each triangle
  int search_ = 0;
  std::vector<int> open_;
};

}  // namespace

RestLayers RestLayers::of(const Surface& cloth, const Level& level, double dhat) {
  const Positions& rest = level.rest.vertices;
  const std::vector<ContactPair> pairs = pairs_within_dhat(cloth, rest, dhat);
  std::vector<double> reach(pairs.size());
  parallel_for(static_cast<int>(pairs.size()), pairs_per_task, [&](int begin, int end) {
    PathSearch paths(level, neighbourhood * dhat);
    for (int i = begin; i < end; ++i) {
      const PairPositions at = positions_of(pairs[i], rest, {});
      const Closest nearest = closest(pairs[i].kind, at);
      const Eigen::Vector3d centre = 0.5 * at * nearest.c.cwiseAbs(),
                            goal = at.rightCols(4 - first_primitive_size(pairs[i].kind)).rowwise().mean();
      if (!paths.connects(pairs[i], centre, goal))
        reach[i] = std::max(connection(at, nearest).norm(), smallest_reach * dhat);
    }
  });
  RestLayers result;
  result.dhat_ = dhat;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    result.pairs_.push_back({{pairs[i].vertices, pairs[i].kind}, reach[i]});
  std::ranges::sort(result.pairs_, {}, &RestPair::key);
  return result;
}

double RestLayers::dhat_of(const ContactPair& pair) const {
  const Key key(pair.vertices, pair.kind);
  const auto found = std::ranges::lower_bound(pairs_, key, {}, &RestPair::key);
  return found != pairs_.end() && found->key == key ? found->dhat : dhat_;
}

std::string RestLayers::remark() const {
  const auto neighbours = std::ranges::count(pairs_, 0.0, &RestPair::dhat);
  if (neighbours == 0) return "";
  return std::to_string(neighbours) +
         " pairs of the cloth's vertices, edges and triangles are closer than dhat = " + three_digits(dhat_) +
         " m at rest and neighbours along the cloth: they have no barrier, and collision detection alone "
         "keeps them apart; a dhat below the shortest edge leaves none";
}

}  // namespace drape::ipc
