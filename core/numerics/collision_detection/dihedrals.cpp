#include "core/numerics/collision_detection/dihedrals.h"

#include <Eigen/Geometry>
#include <atomic>
#include <cmath>
#include <limits>

namespace drape {
namespace {

/// Smaller angles are round-off of the vertices [rad].
constexpr double flat_angle = 1e-6;
/// Edges with a larger angle are rims [rad].
constexpr double rim_angle = M_PI / 6;

/// The bend in a slot, which make() makes if there is none. Threads that make it at once write the same.
template <class Make>
Bend made_once(Bend& slot, const Make& make) {
  const std::atomic_ref<double> angle(slot.angle), curvature(slot.curvature), area(slot.area);
  if (const double made = area.load(std::memory_order_acquire); made != 0)
    return {angle.load(std::memory_order_relaxed), curvature.load(std::memory_order_relaxed), made};
  const Bend bend = make();
  angle.store(bend.angle, std::memory_order_relaxed);
  curvature.store(bend.curvature, std::memory_order_relaxed);
  area.store(bend.area, std::memory_order_release);
  return bend;
}

}  // namespace

Dihedrals::Dihedrals(const ObstacleSurface& surface)
    : surface_(surface), edges_(surface.topology->edges.rows()), vertices_(surface.vertices.rows()) {}

Bend Dihedrals::edge(int e) const {
  return made_once(edges_[e], [&] { return made_edge(e); });
}

Bend Dihedrals::vertex(int v) const {
  return made_once(vertices_[v], [&] { return made_vertex(v); });
}

bool Dihedrals::edge_is_rim(int e) const { return edge(e).angle > rim_angle; }

Bend Dihedrals::made_edge(int e) const {
  const ObstacleTopology& topology = *surface_.topology;
  const Eigen::RowVector3d from = surface_.vertices.row(topology.edges(e, 0)),
                           along = surface_.vertices.row(topology.edges(e, 1)) - from;
  // Of the edge's two triangles, from the edge to the opposite vertex.
  Eigen::RowVector3d height[2] = {Eigen::RowVector3d::Zero(), Eigen::RowVector3d::Zero()};
  double least = std::numeric_limits<double>::infinity();
  int count = 0;
  Bend bend{M_PI, 0, 0};
  for (const int corner : topology.edge_corners.row(e)) {
    const Eigen::RowVector3d to = surface_.vertices.row(topology.triangles(corner / 3, corner % 3)) - from;
    const int which = std::min(count++, 1);
    height[which] = to - to.dot(along) / along.squaredNorm() * along;
    least = std::min(least, height[which].norm());
    bend.area += triangle_area(corner / 3) / 3;
  }
  const Eigen::Vector3d a = height[0], b = height[1];
  if (count == 2) bend.angle = std::atan2(a.cross(b).norm(), -a.dot(b));
  if (bend.angle < flat_angle) bend.angle = 0;
  if (count == 2) bend.curvature = 2 * bend.angle / (a.norm() + b.norm());
  if (count > 2) bend.curvature = M_PI / least;
  return bend;
}

Bend Dihedrals::made_vertex(int v) const {
  const ObstacleTopology& topology = *surface_.topology;
  int rims[2] = {-1, -1}, count = 0;
  for (const int e : topology.vertex_edges.row(v)) {
    if (!edge_is_rim(e)) continue;
    if (count < 2) rims[count] = e;
    ++count;
  }
  Bend bend = count == 2 ? rim_bend(v, rims[0], rims[1]) : Bend();
  for (const int e : topology.vertex_edges.row(v)) {
    if (count == 2 && (e == rims[0] || e == rims[1])) continue;
    bend.angle = std::max(bend.angle, edge(e).angle);
    bend.curvature = std::max(bend.curvature, edge(e).curvature);
  }
  for (const int t : topology.vertex_triangles.row(v)) bend.area += triangle_area(t) / 3;
  return bend;
}

Bend Dihedrals::rim_bend(int v, int e, int f) const {
  const auto along = [&](int edge) -> Eigen::Vector3d {
    const auto ends = surface_.topology->edges.row(edge);
    return surface_.vertices.row(ends[ends[0] == v]) - surface_.vertices.row(v);
  };
  const Eigen::Vector3d a = along(e), b = along(f);
  const double angle = std::atan2(a.cross(b).norm(), -a.dot(b));
  if (angle < flat_angle) return {};
  return {angle, 2 * angle / (a.norm() + b.norm()), 0};
}

double Dihedrals::triangle_area(int t) const {
  const auto corner = [&](int k) -> Eigen::Vector3d {
    return surface_.vertices.row(surface_.topology->triangles(t, k));
  };
  return 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
}

double Dihedrals::unreduced(int e, double dhat) const {
  constexpr double full = 0.25, none = 1;  // largest curvature with coefficient 1, smallest with 0 [1/d̂]
  const double reduction = (dhat * edge(e).curvature - full) / (none - full);
  return 1 - std::clamp(reduction, 0.0, 1.0);
}

double Dihedrals::edge_coefficient(int e, double dhat) const {
  return further(e) == 0 ? 0 : further(e) * unreduced(e, dhat);
}

double Dihedrals::vertex_coefficient(int v, double dhat) const {
  double part = -1;  // at a vertex of single triangles no edge reduces it
  int euler = 1 - surface_.topology->vertex_triangles.size(v);
  for (const int e : surface_.topology->vertex_edges.row(v)) {
    if (further(e) == 0) continue;
    euler += further(e);
    part = std::max(part, unreduced(e, dhat));
  }
  return part < 0 ? std::min(euler, 0) : part * euler;
}

}  // namespace drape
