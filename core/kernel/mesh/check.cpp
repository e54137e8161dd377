#include "core/kernel/mesh/check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/kernel/files/message_text.h"
#include "core/kernel/mesh/extent.h"
#include "core/kernel/mesh/half_edges.h"

namespace drape {
namespace {

/// The first faults, and how many more there are.
class Faults {
 public:
  void push_back(std::string fault) {
    if (listed_.size() < most_listed)
      listed_.push_back(std::move(fault));
    else
      ++more_;
  }
  [[nodiscard]] bool empty() const { return listed_.empty(); }
  std::vector<std::string> all() && {
    if (more_ > 0) listed_.push_back("and " + std::to_string(more_) + " more faults like these");
    return std::move(listed_);
  }

 private:
  static constexpr std::size_t most_listed = 20;
  std::vector<std::string> listed_;
  std::size_t more_ = 0;
};

std::string text(int number) { return std::to_string(number); }

/// Ends a text with indices: a mesh file's own, and messages with its lines, may count from 1.
constexpr const char* from_0 = " (counted from 0)";

std::string triangle_name(const Triangles& triangles, int t) {
  return "triangle " + text(t) + " (" + text(triangles(t, 0)) + ", " + text(triangles(t, 1)) + ", " +
         text(triangles(t, 2)) + ")";
}

std::string edge_name(const HalfEdge& e) {
  return "edge (" + text(e.smaller()) + ", " + text(e.larger()) + ")";
}

bool repeats_vertex(const Triangles& triangles, int t) {
  const auto v = triangles.row(t);
  return v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
}

std::array<Eigen::Vector3d, 3> corners(const TriangleMesh& mesh, int t) {
  const auto v = mesh.triangles.row(t);
  return {mesh.vertices.row(v[0]), mesh.vertices.row(v[1]), mesh.vertices.row(v[2])};
}

bool check_indices(const TriangleMesh& mesh, Faults& faults) {
  const int n = static_cast<int>(mesh.vertices.rows());
  bool in_range = true;
  std::vector<char> used(n, 0);
  for (int t = 0; t < mesh.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.triangles(t, k);
      if (v >= 0 && v < n) {
        used[v] = 1;
        continue;
      }
      faults.push_back(triangle_name(mesh.triangles, t) + " names vertex " + text(v) +
                       ", but vertices go from 0 to " + text(n - 1));
      in_range = false;
    }
  for (int v = 0; v < n; ++v)
    if (!used[v]) faults.push_back("vertex " + text(v) + " belongs to no triangle" + from_0);
  return in_range;
}

void check_shapes(const TriangleMesh& mesh, Faults& faults) {
  for (int t = 0; t < mesh.triangles.rows(); ++t) {
    if (repeats_vertex(mesh.triangles, t)) {
      faults.push_back(triangle_name(mesh.triangles, t) + " repeats a vertex" + from_0);
      continue;
    }
    const auto [a, b, c] = corners(mesh, t);
    const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    if ((b - a).cross(c - a).norm() <= smallest_height * longest)  // false where a coordinate is NaN
      faults.push_back(triangle_name(mesh.triangles, t) + " has no area" + from_0);
  }
}

void check_duplicates(const Triangles& triangles, Faults& faults) {
  std::vector<std::pair<std::array<int, 3>, int>> sorted;
  for (int t = 0; t < triangles.rows(); ++t) {
    std::array<int, 3> v{triangles(t, 0), triangles(t, 1), triangles(t, 2)};
    std::sort(v.begin(), v.end());
    sorted.emplace_back(v, t);
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i].first == sorted[i - 1].first)
      faults.push_back(triangle_name(triangles, sorted[i].second) + " has the same vertices as triangle " +
                       text(sorted[i - 1].second) + from_0);
}

/// Sets of triangle corners that are connected across edges; each set is a fan.
class Fans {
 public:
  explicit Fans(int corner_count) : parent_(corner_count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(int i, int j) { parent_[find(i)] = find(j); }

 private:
  std::vector<int> parent_;
};

/// Corner of the half-edge's triangle at its start or end vertex.
int corner_at(int half_edge, bool end) {
  return half_edge - half_edge % 3 + (half_edge % 3 + (end ? 2 : 1)) % 3;
}

void check_edge(const Triangles& triangles, const std::vector<int>& sides, Faults& faults) {
  const HalfEdge e = HalfEdge::of(triangles, sides[0]);
  if (sides.size() > 2) {
    constexpr std::size_t most_named = 8;
    std::string names;
    for (std::size_t k = 0; k < std::min(sides.size(), most_named); ++k)
      names += (names.empty() ? " " : ", ") + text(sides[k] / 3);
    if (sides.size() > most_named) names += ", …";
    faults.push_back(edge_name(e) + " has " + text(static_cast<int>(sides.size())) + " triangles:" + names +
                     from_0);
  } else if (sides.size() == 2 && HalfEdge::of(triangles, sides[1]).from == e.from) {
    faults.push_back(edge_name(e) + " runs in the same direction in triangles " + text(sides[0] / 3) +
                     " and " + text(sides[1] / 3) + from_0 + ": one of them is inverted");
  }
}

void check_connectivity(const Triangles& triangles, int vertex_count, Faults& faults) {
  std::vector<int> order = half_edges_by_edge(triangles, vertex_count);
  std::erase_if(order, [&](int h) { return repeats_vertex(triangles, h / 3); });
  Fans fans(static_cast<int>(3 * triangles.rows()));
  std::vector<int> sides;
  for (std::size_t i = 0; i < order.size(); i += sides.size()) {
    const HalfEdge e = HalfEdge::of(triangles, order[i]);
    sides.clear();
    for (std::size_t j = i; j < order.size() && HalfEdge::of(triangles, order[j]).same_edge(e); ++j)
      sides.push_back(order[j]);
    check_edge(triangles, sides, faults);
    for (int h : sides) {
      const bool same_direction = HalfEdge::of(triangles, h).from == e.from;
      fans.unite(corner_at(h, !same_direction), corner_at(sides[0], false));
      fans.unite(corner_at(h, same_direction), corner_at(sides[0], true));
    }
  }

  std::vector<int> fan_count(vertex_count, 0);
  for (int c = 0; c < 3 * triangles.rows(); ++c)
    if (fans.find(c) == c && !repeats_vertex(triangles, c / 3)) ++fan_count[triangles(c / 3, c % 3)];
  for (int v = 0; v < vertex_count; ++v)
    if (fan_count[v] > 1)
      faults.push_back("vertex " + text(v) + " joins " + text(fan_count[v]) + " separate fans of triangles" +
                       from_0);
}

void check_flat_orientation(const TriangleMesh& mesh, Faults& faults) {
  if (!(mesh.vertices.col(2).array() == 0).all()) return;
  std::vector<int> up, down;
  for (int t = 0; t < mesh.triangles.rows(); ++t) {
    const auto [a, b, c] = corners(mesh, t);
    const double z = (b - a).cross(c - a).z();
    if (z > 0) up.push_back(t);
    if (z < 0) down.push_back(t);
  }
  for (int t : up.size() < down.size() ? up : down)
    faults.push_back(triangle_name(mesh.triangles, t) + " faces the other way than most of this flat mesh" +
                     from_0);
}

}  // namespace

std::vector<std::string> check_coordinates(const Positions& x) {
  constexpr double largest_rounding = 1e-6;  // of a coordinate, relative to the diagonal
  Faults faults;
  for (int v = 0; v < x.rows(); ++v) {
    const double largest = x.row(v).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    if (!std::isfinite(largest))
      faults.push_back("vertex " + text(v) + from_0 + " has a coordinate that is not finite");
    else if (largest > largest_coordinate)
      faults.push_back("vertex " + text(v) + from_0 + " has a coordinate of " + three_digits(largest) +
                       " m; at most " + three_digits(largest_coordinate) + " m can be computed with");
  }
  if (x.rows() == 0 || !faults.empty()) return std::move(faults).all();
  const double diagonal = bounding_box_diagonal(x);
  const double distance = x.cwiseAbs().maxCoeff();
  const double rounding = distance * std::numeric_limits<double>::epsilon();
  if (diagonal < smallest_diagonal)
    faults.push_back("the mesh is " + three_digits(diagonal) + " m across; at least " +
                     three_digits(smallest_diagonal) + " m can be computed with");
  else if (rounding > largest_rounding * diagonal)
    faults.push_back("the mesh is " + three_digits(diagonal) + " m across and " + three_digits(distance) +
                     " m from the origin, where rounding moves vertices by " + three_digits(rounding) +
                     " m; move it nearer");
  return std::move(faults).all();
}

std::vector<std::string> check_mesh(const TriangleMesh& mesh) {
  Faults faults;
  if (mesh.vertices.rows() == 0) faults.push_back("the mesh has no vertices");
  if (mesh.triangles.rows() == 0) faults.push_back("the mesh has no triangles");
  if (!check_indices(mesh, faults) || mesh.triangles.rows() == 0) return std::move(faults).all();
  if (const std::vector<std::string> coordinates = check_coordinates(mesh.vertices); !coordinates.empty()) {
    for (const std::string& fault : coordinates) faults.push_back(fault);
    return std::move(faults).all();
  }
  check_shapes(mesh, faults);
  check_duplicates(mesh.triangles, faults);
  check_connectivity(mesh.triangles, static_cast<int>(mesh.vertices.rows()), faults);
  check_flat_orientation(mesh, faults);
  return std::move(faults).all();
}

double smallest_angle(const TriangleMesh& mesh) {
  if (mesh.triangles.rows() == 0) return 0;
  double smallest = std::numbers::pi;
  for (int t = 0; t < mesh.triangles.rows(); ++t) {
    const auto p = corners(mesh, t);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d a = p[(k + 1) % 3] - p[k], b = p[(k + 2) % 3] - p[k];
      smallest = std::min(smallest, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  }
  return smallest * 180 / std::numbers::pi;
}

}  // namespace drape
