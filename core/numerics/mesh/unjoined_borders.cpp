#include "core/numerics/mesh/unjoined_borders.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

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
      : x_(mesh.vertices), parts_(static_cast<int>(mesh.vertices.rows())), edges_at_(mesh.vertices.rows()) {
    for (const auto& t : mesh.triangles.rowwise()) {
      parts_.unite(t[0], t[1]);
      parts_.unite(t[1], t[2]);
    }
    for (const int h : border)
      edges_.push_back({HalfEdge::of(mesh.triangles, h), mesh.triangles(h / 3, h % 3)});
    for (int i = 0; i < static_cast<int>(edges_.size()); ++i)
      for (const int v : {edges_[i].from, edges_[i].to}) {
        if (edges_at_[v].empty()) vertices_.push_back(v);
        edges_at_[v].push_back(i);
      }
    (x_.colwise().maxCoeff() - x_.colwise().minCoeff()).maxCoeff(&axis_);
    std::ranges::sort(vertices_, {}, [&](int v) { return std::pair(x_(v, axis_), v); });
  }

  std::vector<TJunction> all() {
    std::vector<TJunction> found;
    for (const BorderEdge& e : edges_) {
      const double margin = on_line * (x_.row(e.to) - x_.row(e.from)).norm();
      const auto [low, high] = std::minmax(x_(e.from, axis_), x_(e.to, axis_));
      for (auto v =
               std::ranges::lower_bound(vertices_, low - margin, {}, [&](int i) { return x_(i, axis_); });
           v != vertices_.end() && x_(*v, axis_) <= high + margin; ++v)
        if (is_inside(*v, e) && has_neighbour_across(*v, e)) found.push_back({*v, {e.from, e.to}});
    }
    std::ranges::sort(found, {}, [](const TJunction& j) { return std::pair(j.vertex, j.edge); });
    return found;
  }

 private:
  RowVector3d off_line(const BorderEdge& e, int v) const {
    const RowVector3d along = (x_.row(e.to) - x_.row(e.from)).normalized(), to = x_.row(v) - x_.row(e.from);
    return to - to.dot(along) * along;
  }

  bool is_inside(int v, const BorderEdge& e) {
    if (v == e.from || v == e.to || parts_.find(v) != parts_.find(e.from)) return false;
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
  DisjointSets parts_;
  std::vector<BorderEdge> edges_;
  std::vector<int> vertices_;               // of the border, along axis_
  std::vector<std::vector<int>> edges_at_;  // of each vertex
  Eigen::Index axis_ = 0;                   // the longest of the mesh's box
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

Coincidence coincident_border(const Level& level, double tolerance) {
  // Each border vertex is compared with those in the 27 cells around it, of a grid as fine as the tolerance.
  using Cell = std::array<double, 3>;
  const Positions& x = level.rest.vertices;
  std::multimap<Cell, int> seen;
  Coincidence found;
  for (int v = 0; v < level.vertex_count(); ++v) {
    if (!level.topology.on_border[v]) continue;
    Cell cell;
    for (int c = 0; c < 3; ++c) cell[c] = std::floor(x(v, c) / tolerance);
    int on = -1;
    for (int n = 0; n < 27 && on < 0; ++n) {
      const int offset[] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
      const Cell near{cell[0] + offset[0], cell[1] + offset[1], cell[2] + offset[2]};
      const auto [begin, end] = seen.equal_range(near);
      for (auto it = begin; it != end && on < 0; ++it)
        if ((x.row(v) - x.row(it->second)).norm() < tolerance) on = it->second;
    }
    seen.emplace(cell, v);
    if (on < 0) continue;
    if (found.count++ == 0) found = {on, v, 1};
  }
  return found;
}

}  // namespace drape
