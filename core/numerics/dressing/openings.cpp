#include "core/numerics/dressing/openings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <utility>

#include "core/numerics/collision_detection/box_tree.h"
#include "core/numerics/collision_detection/components.h"
#include "core/numerics/mesh/mesh_faults.h"
#include "core/numerics/mesh/seams.h"

namespace drape {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Smallest extent of a part of the body that passes through an opening [m].
constexpr double least_part = 0.02;
/// Distance from one curve that is tried to the next [m].
constexpr double curve_step = 0.03;
/// Curves shorter than this part of the longest one are dents of the cloth, and not branches of the tube.
constexpr double smallest_branch = 0.15;
/// The tube that leads to an opening ends where a curve is longer than this factor times the border, and this
/// part of the distance from it: trouser legs widen by 0.4, and at an armhole curves widen by 3 or more.
constexpr double widest_tube = 1.1, steepest_tube = 0.6;

double length_of(const Positions& curve) {
  double length = 0;
  for (Eigen::Index i = 0; i < curve.rows(); ++i)
    length += (curve.row((i + 1) % curve.rows()) - curve.row(i)).norm();
  return length;
}

/// A triangle of a fan, which counts as closed: an edge that meets two of them is cut all the same.
struct FanTriangle {
  Eigen::Matrix3d corners;  // one a column [m]
  Eigen::Vector3d normal;   // twice its area long

  FanTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    corners << a, b, c;
    normal = (b - a).cross(c - a);
  }
  Box box(const Eigen::Vector3d& origin) const {
    return Box::around(corners.rowwise().minCoeff() - origin, corners.rowwise().maxCoeff() - origin, 0);
  }
  /// 1 where a segment passes through along the normal, -1 against it, 0 beside it.
  int crossing(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    constexpr double rounding = 1e-9;
    const double start = (from - corners.col(0)).dot(normal), end = (to - corners.col(0)).dot(normal);
    if ((start < 0) == (end < 0)) return 0;
    const Eigen::Vector3d at = from + start / (start - end) * (to - from);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d side = corners.col((k + 1) % 3) - corners.col(k);
      if (side.cross(at - corners.col(k)).dot(normal) < -rounding * normal.squaredNorm()) return 0;
    }
    return start < 0 ? 1 : -1;
  }
};

/// A body whose parts closed curves separate.
class BodyParts {
 public:
  explicit BodyParts(const TriangleMesh& body)
      : x_(body.vertices),
        topology_(Topology::of_any(body.triangles, static_cast<int>(body.vertices.rows()))),
        component_(component_numbers(topology_)),
        origin_(bounding_box(x_).center()) {
    std::vector<Box> boxes;
    for (const auto& e : topology_.edges.rowwise())
      boxes.push_back(Box::around(point(e[0]) - origin_, point(e[1]) - origin_, 0));
    edges_.build(boxes);
  }

  /// Whether a part of the body passes through a closed curve.
  bool pass(const Positions& curve) const {
    const std::vector<int> cut = edges_through(curve);
    if (cut.empty()) return false;
    std::vector<char> is_cut(topology_.edges.rows(), 0);
    for (const int e : cut) is_cut[e] = 1;
    DisjointSets sets(static_cast<int>(x_.rows()));
    for (Eigen::Index e = 0; e < topology_.edges.rows(); ++e)
      if (!is_cut[e]) sets.unite(topology_.edges(e, 0), topology_.edges(e, 1));
    std::map<int, std::map<int, Eigen::AlignedBox3d>> parts;  // of each component that is cut, by their sets
    for (const int e : cut)
      for (const int v : topology_.edges.row(e)) parts[component_[v]][sets.find(v)];
    for (int v = 0; v < x_.rows(); ++v)
      if (const auto own = parts.find(component_[v]); own != parts.end())
        if (const auto part = own->second.find(sets.find(v)); part != own->second.end())
          part->second.extend(x_.row(v).transpose());
    // Of a body that the cloth intersects, the fan may cut into a component without leaving it.
    const bool goes_through = std::ranges::none_of(topology_.triangle_edges.rowwise(), [&](const auto& own) {
      return is_cut[own[0]] + is_cut[own[1]] + is_cut[own[2]] == 1;
    });
    return std::ranges::any_of(parts, [&](const auto& component) {
      const auto& own = component.second;
      const auto is_large = [](const auto& part) { return part.second.sizes().norm() >= least_part; };
      return (own.size() == 1 && goes_through) || std::ranges::count_if(own, is_large) > 1;
    });
  }

 private:
  Eigen::Vector3d point(int v) const { return x_.row(v); }

  /// The edges of the body that pass through the fan more often one way than the other.
  std::vector<int> edges_through(const Positions& curve) const {
    std::vector<FanTriangle> fan;
    std::vector<Box> boxes;
    const Eigen::Vector3d middle = curve.colwise().mean();
    for (Eigen::Index i = 0; i < curve.rows(); ++i) {
      fan.emplace_back(middle, curve.row(i), curve.row((i + 1) % curve.rows()));
      boxes.push_back(fan.back().box(origin_));
    }
    BoxTree tree;
    tree.build(boxes);
    std::map<int, int> crossings;  // of each edge
    const auto count = [&](int t, int e) {
      if (const int sign = fan[t].crossing(point(topology_.edges(e, 0)), point(topology_.edges(e, 1))))
        crossings[e] += sign;
    };
    for (int run = 0; run < tree.runs(); ++run) tree.overlaps(edges_, run, count, [] { return false; });
    std::vector<int> through;
    for (const auto& [edge, sum] : crossings)
      if (sum != 0) through.push_back(edge);
    return through;
  }

  const Positions& x_;
  const Topology topology_;
  const std::vector<int> component_;
  const Eigen::Vector3d origin_;  // of the boxes, which have floats
  BoxTree edges_;
};

/// Distances along the cloth's edges from a border [m]; +∞ in other connected parts (Dijkstra).
std::vector<double> distances_from(const std::vector<int>& border, const Topology& topology,
                                   const Positions& x) {
  using Reached = std::pair<double, int>;
  std::vector<double> distances(x.rows(), infinity);
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
  const auto reach = [&](int v, double distance) {
    if (distance >= distances[v]) return;
    distances[v] = distance;
    next.emplace(distance, v);
  };
  for (const int v : border) reach(v, 0);
  while (!next.empty()) {
    const auto [distance, v] = next.top();
    next.pop();
    if (distance > distances[v]) continue;
    for (const int other : topology.vertex_vertices.row(v))
      reach(other, distance + (x.row(other) - x.row(v)).norm());
  }
  return distances;
}

/// The closed curves at a distance from a border; none if one of them ends at another border.
std::vector<Positions> curves_at(double distance, const std::vector<double>& distances,
                                 const Topology& topology, const Positions& x) {
  const auto& edges = topology.edges;
  const auto is_crossed = [&](int e) {
    return (distances[edges(e, 0)] < distance) != (distances[edges(e, 1)] < distance);
  };
  std::vector<Positions> curves;
  std::vector<char> seen(edges.rows(), 0);
  for (int first = 0; first < edges.rows(); ++first) {
    if (seen[first] || !is_crossed(first)) continue;
    std::vector<Eigen::RowVector3d> points;
    for (int e = first, t = topology.edge_triangles(first, 0); !seen[e];) {
      seen[e] = 1;
      const double from = distances[edges(e, 0)], part = (distance - from) / (distances[edges(e, 1)] - from);
      points.push_back(x.row(edges(e, 0)) + part * (x.row(edges(e, 1)) - x.row(edges(e, 0))));
      if (topology.edge_triangles(e, 1) < 0) return {};
      for (const int other : topology.triangle_edges.row(t))  // which has one more crossed edge
        if (other != e && is_crossed(other)) {
          e = other;
          break;
        }
      t = topology.edge_triangles(e, 0) == t ? topology.edge_triangles(e, 1) : topology.edge_triangles(e, 0);
      if (t < 0) return {};
    }
    curves.emplace_back(points.size(), 3);
    for (std::size_t i = 0; i < points.size(); ++i)
      curves.back().row(static_cast<Eigen::Index>(i)) = points[i];
  }
  return curves;
}

/// Whether a part of the body passes through a border, or through the tube of cloth that leads to it.
bool is_passed(const std::vector<int>& border, const Topology& topology, const Positions& x,
               const BodyParts& body) {
  const Positions loop = x(border, Eigen::all);
  if (body.pass(loop)) return true;
  const double length = length_of(loop);
  const std::vector<double> distances = distances_from(border, topology, x);
  for (double distance = curve_step;; distance += curve_step) {
    const std::vector<Positions> curves = curves_at(distance, distances, topology, x);
    if (curves.empty()) return false;
    std::vector<double> lengths;
    for (const Positions& curve : curves) lengths.push_back(length_of(curve));
    const auto longest = std::ranges::max_element(lengths);
    if (std::ranges::count_if(lengths, [&](double own) { return own > smallest_branch * *longest; }) > 1)
      return false;
    if (*longest > widest_tube * length + steepest_tube * distance) return false;
    if (body.pass(curves[longest - lengths.begin()])) return true;
  }
}

/// The borders of triangles, each as half-edges that follow one another.
std::vector<std::vector<int>> border_loops(const TriangleMesh& mesh) {
  std::map<int, int> next;  // the half-edge that begins at a vertex
  for (const int h : border_half_edges(mesh.triangles, static_cast<int>(mesh.vertices.rows())))
    next[HalfEdge::of(mesh.triangles, h).from] = h;
  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    loops.emplace_back();
    for (auto at = next.begin(); at != next.end();) {
      loops.back().push_back(at->second);
      next.erase(at);
      at = next.find(HalfEdge::of(mesh.triangles, loops.back().back()).to);
    }
  }
  return loops;
}

}  // namespace

std::vector<Opening> openings_of(const Level& level, const Positions& x, const TriangleMesh& body) {
  const Triangles& triangles = level.rest.triangles;
  const std::vector<int> part = component_numbers(level.topology);
  std::vector<int> seams_and_borders(part.size(), 0);  // of each part
  for (const int e : seam_edges(level.rest, level.topology))
    ++seams_and_borders[part[level.topology.edges(e, 0)]];
  const std::vector<std::vector<int>> loops = border_loops(level.rest);
  for (const std::vector<int>& loop : loops) ++seams_and_borders[part[triangles(loop[0] / 3, 0)]];
  const BodyParts parts(body);
  std::vector<Opening> openings;
  for (const std::vector<int>& loop : loops) {
    if (seams_and_borders[part[triangles(loop[0] / 3, 0)]] == 1) continue;
    std::vector<int> border;
    for (const int h : loop) border.push_back(HalfEdge::of(triangles, h).from);
    const Positions points = x(border, Eigen::all);
    openings.push_back({loop, length_of(points), points.colwise().mean().transpose(),
                        is_passed(border, level.topology, x, parts)});
  }
  std::ranges::stable_sort(openings, std::greater<>(), &Opening::length);
  return openings;
}

}  // namespace drape
