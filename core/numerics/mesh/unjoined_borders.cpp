#include "core/numerics/mesh/unjoined_borders.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/kernel/files/message_text.h"
#include "core/kernel/interfaces/topology.h"
#include "core/numerics/mesh/disjoint_sets.h"
#include "core/numerics/mesh/mesh_faults.h"

namespace drape {
namespace {

using Eigen::RowVector3d;

/// Distances from a line below this part of an edge's length are the rounding of a file's numbers.
constexpr double on_line = 1e-4;

/// Whether no triangle shares more than one of its edges.
bool has_only_pieces(const Triangles& triangles, const std::vector<int>& border) {
  std::vector<int> sides(triangles.rows(), 0);
  for (const int h : border) ++sides[h / 3];
  return std::ranges::all_of(sides, [](int count) { return count >= 2; });
}

/// A border edge with its triangle's corner opposite.
struct BorderEdge : HalfEdge {
  int opposite;
};

class JunctionSearch {
 public:
  JunctionSearch(const TriangleMesh& mesh, const std::vector<int>& border)
      : x_(mesh.vertices), edges_at_(mesh.vertices.rows()) {
    DisjointSets parts(static_cast<int>(mesh.vertices.rows()));
    for (const auto& t : mesh.triangles.rowwise()) {
      parts.unite(t[0], t[1]);
      parts.unite(t[1], t[2]);
    }
    part_ = parts.numbered();
    for (const int h : border)
      edges_.push_back({HalfEdge::of(mesh.triangles, h), mesh.triangles(h / 3, h % 3)});
    for (int i = 0; i < static_cast<int>(edges_.size()); ++i)
      for (const int v : {edges_[i].from, edges_[i].to}) {
        if (edges_at_[v].empty()) vertices_.push_back(v);
        edges_at_[v].push_back(i);
      }
    std::ranges::stable_sort(vertices_, {}, [&](int v) { return part_[v]; });
    for (int begin = 0, end = 0; begin < std::ssize(vertices_); begin = end) {
      const int part = part_[vertices_[begin]];
      for (end = begin; end < std::ssize(vertices_) && part_[vertices_[end]] == part;) ++end;
      trees_.resize(part + 1);
      trees_[part] = {begin, end, {}};
      split(trees_[part].balls, 0, begin, end);
    }
  }

  std::vector<TJunction> all() const {
    std::vector<TJunction> found;
    for (const BorderEdge& e : edges_) {
      const Tree& own = trees_[part_[e.from]];
      visit(own.balls, 0, own.begin, own.end, reach_of(e), [&](int v) {
        if (is_inside(v, e) && has_neighbour_across(v, e)) found.push_back({v, {e.from, e.to}});
      });
    }
    std::ranges::sort(found, {}, [](const TJunction& j) { return std::pair(j.vertex, j.edge); });
    return found;
  }

 private:
  /// A ball around the vertices of a node, whose children have its halves along the longest axis of its box.
  struct Ball {
    RowVector3d centre;
    double radius;
  };
  using Balls = std::vector<Ball>;  // of nodes; the children of node k are 2k + 1 and 2k + 2
  struct Tree {
    int begin = 0, end = 0;  // of its part's vertices
    Balls balls;
  };
  static constexpr int leaf = 8;  // vertices

  void split(Balls& balls, std::size_t node, int begin, int end) {
    const std::vector<int> own(vertices_.begin() + begin, vertices_.begin() + end);
    const Positions x = x_(own, Eigen::all);
    const RowVector3d low = x.colwise().minCoeff(), size = x.colwise().maxCoeff() - low;
    if (balls.size() <= node) balls.resize(node + 1);
    balls[node] = {low + size / 2, size.norm() / 2};
    if (end - begin <= leaf) return;
    Eigen::Index axis = 0;
    size.maxCoeff(&axis);
    const int middle = (begin + end) / 2;
    std::nth_element(vertices_.begin() + begin, vertices_.begin() + middle, vertices_.begin() + end,
                     [&](int a, int b) { return std::pair(x_(a, axis), a) < std::pair(x_(b, axis), b); });
    split(balls, 2 * node + 1, begin, middle);
    split(balls, 2 * node + 2, middle, end);
  }

  /// Where an edge goes from a vertex, and how far from it one may lie that is on it.
  struct Reach {
    RowVector3d from, along, per_length;  ///< per_length: along over its length's square
    double distance;
  };
  Reach reach_of(const BorderEdge& e) const {
    const RowVector3d along = x_.row(e.to) - x_.row(e.from);
    return {x_.row(e.from), along, along / along.squaredNorm(), 2 * on_line * along.norm()};
  }

  /// Visits the vertices of a node that may lie on the edge.
  template <class Visit>
  void visit(const Balls& balls, std::size_t node, int begin, int end, const Reach& edge,
             const Visit& visit_vertex) const {
    const RowVector3d to = balls[node].centre - edge.from;
    const double at = std::clamp(to.dot(edge.per_length), 0.0, 1.0);
    const double most = balls[node].radius + edge.distance;
    if (!((to - at * edge.along).squaredNorm() <= most * most)) return;
    if (end - begin <= leaf) {
      std::for_each(vertices_.begin() + begin, vertices_.begin() + end, visit_vertex);
      return;
    }
    visit(balls, 2 * node + 1, begin, (begin + end) / 2, edge, visit_vertex);
    visit(balls, 2 * node + 2, (begin + end) / 2, end, edge, visit_vertex);
  }

  RowVector3d off_line(const BorderEdge& e, int v) const {
    const RowVector3d along = (x_.row(e.to) - x_.row(e.from)).normalized(), to = x_.row(v) - x_.row(e.from);
    return to - to.dot(along) * along;
  }

  bool is_inside(int v, const BorderEdge& e) const {
    if (v == e.from || v == e.to) return false;
    const RowVector3d along = x_.row(e.to) - x_.row(e.from);
    const double length = along.norm(), at = along.dot(x_.row(v) - x_.row(e.from)) / length;
    return at > on_line * length && at < (1 - on_line) * length && off_line(e, v).norm() <= on_line * length;
  }

  /// Whether one of v's border edges runs along e, with its triangle on the other side. On the same side two
  /// layers lie on one another.
  bool has_neighbour_across(int v, const BorderEdge& e) const {
    return std::ranges::any_of(edges_at_[v], [&](int i) {
      const BorderEdge& own = edges_[i];
      const int end = own.from == v ? own.to : own.from;
      const double length = (x_.row(end) - x_.row(v)).norm();
      return off_line(e, end).norm() <= on_line * length &&
             off_line(e, own.opposite).dot(off_line(e, e.opposite)) < 0;
    });
  }

  const Positions& x_;
  std::vector<BorderEdge> edges_;
  std::vector<int> part_;                   // of each vertex
  std::vector<int> vertices_;               // of the border, by parts
  std::vector<Tree> trees_;                 // of each part
  std::vector<std::vector<int>> edges_at_;  // of each vertex
};

}  // namespace

std::vector<int> first_at_place(const std::vector<TriangleMesh>& frames) {
  std::vector<int> order(frames[0].vertices.rows()), first(order.size());
  std::iota(order.begin(), order.end(), 0);
  const auto difference = [&](int a, int b) {
    for (const TriangleMesh& frame : frames)
      for (int c = 0; c < 3; ++c)
        if (frame.vertices(a, c) != frame.vertices(b, c)) return frame.vertices(a, c) - frame.vertices(b, c);
    return 0.0;
  };
  std::ranges::stable_sort(order, [&](int a, int b) { return difference(a, b) < 0; });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && difference(order[i - 1], order[i]) == 0 ? first[order[i - 1]] : order[i];
  return first;
}

bool is_soup(const TriangleMesh& mesh) {
  const std::vector<int> border = border_half_edges(mesh.triangles, static_cast<int>(mesh.vertices.rows()));
  if (!has_only_pieces(mesh.triangles, border)) return false;
  const std::vector<int> first = first_at_place({mesh});
  std::vector<std::pair<int, int>> edges;
  for (const int h : border) {
    const HalfEdge e = HalfEdge::of(mesh.triangles, h);
    edges.push_back(std::minmax({first[e.from], first[e.to]}));
  }
  std::ranges::sort(edges);
  std::size_t coincident = 0;
  for (std::size_t i = 0; i < edges.size(); ++i)
    coincident += (i > 0 && edges[i] == edges[i - 1]) || (i + 1 < edges.size() && edges[i] == edges[i + 1]);
  return 2 * coincident > edges.size();
}

std::vector<TJunction> t_junctions(const TriangleMesh& mesh) {
  const std::vector<int> border = border_half_edges(mesh.triangles, static_cast<int>(mesh.vertices.rows()));
  if (border.empty()) return {};
  return JunctionSearch(mesh, border).all();
}

namespace {

/// Vertices by the cells of a grid as fine as a distance [m].
class Cells {
 public:
  Cells(const Positions& x, double distance) : x_(x), size_(distance) {}

  void add(int v) { all_.emplace(cell_of(v), v); }

  /// Visits the added vertices in the 27 cells around v, at most so many of each, until one is taken.
  template <class Take>
  void near(int v, int most, const Take& take) const {
    const Cell cell = cell_of(v);
    for (int n = 0; n < 27; ++n) {
      const int offset[] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
      const Cell near{cell[0] + offset[0], cell[1] + offset[1], cell[2] + offset[2]};
      const auto [begin, end] = all_.equal_range(near);
      int visited = 0;
      for (auto it = begin; it != end && visited < most; ++it, ++visited)
        if (take(it->second)) return;
    }
  }

 private:
  using Cell = std::array<double, 3>;
  Cell cell_of(int v) const {
    return {std::floor(x_(v, 0) / size_), std::floor(x_(v, 1) / size_), std::floor(x_(v, 2) / size_)};
  }

  const Positions& x_;
  double size_;
  std::multimap<Cell, int> all_;
};

/// Border vertices within their own reach of another one, and within `tolerance` [m].
template <class Reach>
Coincidence border_within(const Level& level, double tolerance, const Reach& reach) {
  constexpr int most_compared = 64;  // with those of a cell that has very many
  const Positions& x = level.rest.vertices;
  Cells seen(x, tolerance);
  Coincidence found;
  for (int v = 0; v < level.vertex_count(); ++v) {
    if (!level.topology.on_border[v]) continue;
    int on = -1;
    seen.near(v, most_compared, [&](int other) {
      const double d = (x.row(v) - x.row(other)).norm();
      const bool within = d < tolerance && d < std::min(reach(v), reach(other));
      if (within) on = other;
      return within;
    });
    seen.add(v);
    if (on < 0) continue;
    if (found.count++ == 0) found = {on, v, 1};
  }
  return found;
}

}  // namespace

std::vector<int> join_vertices(TriangleMesh& mesh, double tolerance) {
  constexpr double rounding = 1e-9;  // of the tolerance
  constexpr long most_each = 300;    // compared on average; those of a soup of triangles are some tens
  const auto n = static_cast<int>(mesh.vertices.rows());
  if (!(tolerance > 0)) {
    std::vector<int> same(n);
    std::iota(same.begin(), same.end(), 0);
    return same;
  }
  DisjointSets sets(n);
  Cells seen(mesh.vertices, tolerance * (1 + rounding));
  long compared = 0;
  for (int v = 0; v < n; ++v) {
    seen.near(v, n, [&](int other) {
      if ((mesh.vertices.row(other) - mesh.vertices.row(v)).norm() <= tolerance) sets.unite(other, v);
      return ++compared > most_each * (n + most_each);
    });
    if (compared > most_each * (n + most_each))
      throw std::runtime_error(
          "\"join\" of " + three_digits(tolerance) +
          " m is larger than many edges: it would join hundreds of vertices to one; take "
          "less than the shortest edge");
    seen.add(v);
  }
  std::vector<int> joined = sets.numbered(), kept;  // of each set the first vertex
  for (int v = 0; v < n; ++v)
    if (joined[v] == std::ssize(kept)) kept.push_back(v);
  mesh.vertices = Positions(mesh.vertices(kept, Eigen::all));
  for (int& corner : mesh.triangles.reshaped()) corner = joined[corner];
  return joined;
}

Coincidence coincident_border(const Level& level, double tolerance) {
  return border_within(level, tolerance, [&](int) { return tolerance; });
}

Coincidence nearly_coincident_border(const Level& level, double tolerance) {
  constexpr double part = 0.1;
  std::vector<double> reach(level.vertex_count(), tolerance);
  for (const auto& e : level.topology.edges.rowwise())
    for (const int v : {e[0], e[1]})
      reach[v] =
          std::min(reach[v], part * (level.rest.vertices.row(e[0]) - level.rest.vertices.row(e[1])).norm());
  return border_within(level, tolerance, [&](int v) { return reach[v]; });
}

}  // namespace drape
