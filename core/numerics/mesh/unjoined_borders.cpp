#include "core/numerics/mesh/unjoined_borders.h"

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

/// Whether no triangle shares more than one of its edges.
bool has_only_pieces(const Triangles& triangles, const std::vector<int>& border) {
  std::vector<int> sides(triangles.rows(), 0);
  for (const int h : border) ++sides[h / 3];
  return std::ranges::all_of(sides, [](int count) { return count >= 2; });
}

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
