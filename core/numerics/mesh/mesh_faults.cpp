#include "core/numerics/mesh/mesh_faults.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/kernel/interfaces/topology.h"
#include "core/kernel/plugin/bounds.h"
#include "core/numerics/mesh/disjoint_sets.h"

namespace drape {
namespace {

bool repeats_vertex(const Triangles& triangles, int t) {
  const auto v = triangles.row(t);
  return v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
}

/// Appends a triangle without area or of too small a height; none with a coordinate that is NaN.
void check_height(const TriangleMesh& mesh, int t, MeshFaults& faults) {
  const auto v = mesh.triangles.row(t);
  const Eigen::RowVector3d a = mesh.vertices.row(v[0]), b = mesh.vertices.row(v[1]),
                           c = mesh.vertices.row(v[2]);
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}),
               area = (b - a).cross(c - a).norm(),
               rounding = std::numeric_limits<double>::epsilon() *
                          a.cwiseAbs().cwiseMax(b.cwiseAbs()).cwiseMax(c.cwiseAbs()).maxCoeff();
  if (area <= bounds::smallest_height * longest)
    faults.empty_triangles.push_back(t);
  else if (rounding * std::sqrt(longest) > largest_rounding * area)
    faults.low_triangles.push_back(t);
}

std::vector<MeshFaults::Pair> doubled(const Triangles& triangles) {
  std::vector<std::pair<std::array<int, 3>, int>> sorted;
  for (int t = 0; t < triangles.rows(); ++t) {
    std::array<int, 3> v{triangles(t, 0), triangles(t, 1), triangles(t, 2)};
    std::sort(v.begin(), v.end());
    sorted.emplace_back(v, t);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<MeshFaults::Pair> pairs;
  for (std::size_t i = 1, first = 0; i < sorted.size(); ++i) {
    if (sorted[i].first == sorted[first].first)
      pairs.push_back({sorted[i].second, sorted[first].second});
    else
      first = i;
  }
  std::ranges::sort(pairs, {}, &MeshFaults::Pair::element);
  return pairs;
}

/// Corner of the half-edge's triangle at its start or end vertex.
int corner_at(int half_edge, bool end) {
  return half_edge - half_edge % 3 + (half_edge % 3 + (end ? 2 : 1)) % 3;
}

/// Calls visit(sides) with the half-edges of every edge, ascending.
template <class Visit>
void for_each_edge(const Triangles& triangles, int vertex_count, const std::vector<char>& ignored,
                   const Visit& visit) {
  std::vector<int> order = half_edges_by_edge(triangles, vertex_count), sides;
  if (!ignored.empty()) std::erase_if(order, [&](int h) { return ignored[h / 3] != 0; });
  for (std::size_t i = 0; i < order.size(); i += sides.size()) {
    const HalfEdge e = HalfEdge::of(triangles, order[i]);
    sides.clear();
    for (std::size_t j = i; j < order.size() && HalfEdge::of(triangles, order[j]).same_edge(e); ++j)
      sides.push_back(order[j]);
    visit(sides);
  }
}

/// The signed angle of a triangle's corner k.
double angle(const TriangleMesh& mesh, int t, int k) {
  const auto at = [&](int corner) {
    return Eigen::Vector2d(mesh.vertices.row(mesh.triangles(t, corner % 3)).head<2>());
  };
  const Eigen::Vector2d u = at(k + 1) - at(k), v = at(k + 2) - at(k);
  return std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v));
}

}  // namespace

MeshFaults MeshFaults::of_elements(const TriangleMesh& mesh) {
  MeshFaults faults;
  std::vector<char> used(mesh.vertices.rows(), 0);
  for (int t = 0; t < mesh.triangles.rows(); ++t) {
    for (int k = 0; k < 3; ++k) used[mesh.triangles(t, k)] = 1;
    if (repeats_vertex(mesh.triangles, t))
      faults.repeating_triangles.push_back(t);
    else
      check_height(mesh, t, faults);
  }
  for (int v = 0; v < mesh.vertices.rows(); ++v)
    if (!used[v]) faults.loose_vertices.push_back(v);
  faults.doubled_triangles = doubled(mesh.triangles);
  return faults;
}

void MeshFaults::find_connectivity(const Triangles& triangles, int vertex_count,
                                   const std::vector<char>& ignored) {
  const int corner_count = static_cast<int>(3 * triangles.rows());
  DisjointSets fans(corner_count);  // corners that are connected across edges
  const int triangle_count = static_cast<int>(triangles.rows());
  DisjointSets fronts(2 * triangle_count);  // triangles as they are, then turned over, with the same front
  for_each_edge(triangles, vertex_count, ignored, [&](const std::vector<int>& sides) {
    const HalfEdge e = HalfEdge::of(triangles, sides[0]);
    const bool inverted = sides.size() == 2 && HalfEdge::of(triangles, sides[1]).from == e.from;
    if (sides.size() == 2)
      for (const bool turned : {false, true})
        fronts.unite(sides[0] / 3 + turned * triangle_count,
                     sides[1] / 3 + (turned != inverted) * triangle_count);
    if (sides.size() > 2 || inverted) {
      FaultyEdge fault{e.smaller(), e.larger(), {}};
      for (const int h : sides) fault.triangles.push_back(h / 3);
      (inverted ? inverted_edges : crowded_edges).push_back(std::move(fault));
    }
    for (const int h : sides) {
      const bool same_direction = HalfEdge::of(triangles, h).from == e.from;
      fans.unite(corner_at(h, !same_direction), corner_at(sides[0], false));
      fans.unite(corner_at(h, same_direction), corner_at(sides[0], true));
    }
  });
  for (FaultyEdge& edge : inverted_edges)
    edge.one_sided = fronts.find(edge.triangles[0]) == fronts.find(edge.triangles[0] + triangle_count);
  std::vector<int> fan_count(vertex_count, 0);
  for (int c = 0; c < corner_count; ++c)
    if (fans.find(c) == c && (ignored.empty() || !ignored[c / 3])) ++fan_count[triangles(c / 3, c % 3)];
  for (int v = 0; v < vertex_count; ++v)
    if (fan_count[v] > 1) shared_vertices.push_back({v, fan_count[v]});
}

std::string crowded_vertex(const Triangles& triangles, int vertex_count) {
  constexpr int most = 5000;
  std::vector<int> counts(vertex_count, 0);
  for (const int v : triangles.reshaped()) ++counts[v];
  const auto largest = std::ranges::max_element(counts);
  if (largest == counts.end() || *largest <= most) return "";
  return "vertex " + std::to_string(largest - counts.begin()) + " has " + std::to_string(*largest) +
         " triangles, of at most " + std::to_string(most) +
         " (counted from 0); take a mesh of other triangles there";
}

std::vector<int> border_half_edges(const Triangles& triangles, int vertex_count) {
  std::vector<int> border;
  for_each_edge(triangles, vertex_count, {}, [&](const std::vector<int>& sides) {
    if (sides.size() == 1) border.push_back(sides[0]);
  });
  std::sort(border.begin(), border.end());
  return border;
}

std::vector<int> flat_overlaps(const TriangleMesh& mesh) {
  if (!(mesh.vertices.col(2).array() == 0).all()) return {};
  const Eigen::Index n = mesh.vertices.rows();
  Eigen::VectorXd up = Eigen::VectorXd::Zero(n), down = up;  // sums of the angles at each vertex
  for (int t = 0; t < mesh.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const double a = angle(mesh, t, k);
      (a > 0 ? up : down)[mesh.triangles(t, k)] += a;
    }
  for (const int h : border_half_edges(mesh.triangles, static_cast<int>(n)))
    up[HalfEdge::of(mesh.triangles, h).from] = 0;  // there the angles add up to anything
  std::vector<int> found;
  for (int t = 0; t < mesh.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.triangles(t, k);
      if (up[v] == 0 || down[v] == 0) continue;
      const double turns = (up[v] + down[v]) / (2 * std::numbers::pi);
      if (std::abs(turns) < 0.5 || (angle(mesh, t, k) > 0) == (turns > 0)) continue;
      found.push_back(t);
      break;
    }
  return found;
}

}  // namespace drape
