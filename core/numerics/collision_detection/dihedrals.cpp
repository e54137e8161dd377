#include "core/numerics/collision_detection/dihedrals.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>

namespace drape {
namespace {

/// Smaller angles are round-off of the vertices [rad].
constexpr double flat_angle = 1e-6;
/// Edges with a larger angle are rims [rad].
constexpr double rim_angle = M_PI / 6;

/// The rim edges of each vertex that exactly two of them meet in; (-1, -1) for other vertices.
std::vector<std::array<int, 2>> rims_through_vertices(const Surface& surface, const std::vector<char>& is_rim,
                                                      Eigen::Index vertex_count) {
  std::vector<std::array<int, 2>> rims(vertex_count, {-1, -1});
  std::vector<int> count(vertex_count, 0);
  for (Eigen::Index e = 0; e < surface.edges.rows(); ++e)
    for (int k = 0; k < 2 && is_rim[e]; ++k) {
      const int v = surface.edges(e, k);
      if (count[v] < 2) rims[v][count[v]] = static_cast<int>(e);
      ++count[v];
    }
  for (Eigen::Index v = 0; v < vertex_count; ++v)
    if (count[v] != 2) rims[v] = {-1, -1};
  return rims;
}

}  // namespace

Dihedrals Dihedrals::of(const Surface& surface, const Positions& vertices) {
  const Eigen::Index n = vertices.rows(), count = surface.edges.rows();
  // The heights of each edge's two triangles, from the edge to the opposite vertex.
  Positions height[2] = {Positions::Zero(count, 3), Positions::Zero(count, 3)};
  std::vector<int> triangles(count, 0);
  Eigen::VectorXd least = Eigen::VectorXd::Constant(count, std::numeric_limits<double>::infinity());
  for (int t = 0; t < surface.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int e = surface.triangle_edges(t, k);
      const Eigen::RowVector3d from = vertices.row(surface.edges(e, 0)),
                               along = vertices.row(surface.edges(e, 1)) - from,
                               to = vertices.row(surface.triangles(t, k)) - from;
      const int which = std::min(triangles[e]++, 1);
      height[which].row(e) = to - to.dot(along) / along.squaredNorm() * along;
      least[e] = std::min(least[e], height[which].row(e).norm());
    }
  Dihedrals d;
  d.edge.angle.resize(count);
  d.edge.curvature.setZero(count);
  d.vertex.angle.setZero(n);
  d.vertex.curvature.setZero(n);
  d.edge_is_rim.resize(count);
  for (int e = 0; e < count; ++e) {
    const Eigen::Vector3d a = height[0].row(e), b = height[1].row(e);
    d.edge.angle[e] = triangles[e] != 2 ? M_PI : std::atan2(a.cross(b).norm(), -a.dot(b));
    if (d.edge.angle[e] < flat_angle) d.edge.angle[e] = 0;
    if (triangles[e] == 2) d.edge.curvature[e] = 2 * d.edge.angle[e] / (a.norm() + b.norm());
    if (triangles[e] > 2) d.edge.curvature[e] = M_PI / least[e];
    d.edge_is_rim[e] = d.edge.angle[e] > rim_angle;
  }
  const auto rims = rims_through_vertices(surface, d.edge_is_rim, n);
  for (int e = 0; e < count; ++e)
    for (int k = 0; k < 2; ++k) {
      const int v = surface.edges(e, k);
      if (rims[v][0] == e || rims[v][1] == e) continue;
      d.vertex.angle[v] = std::max(d.vertex.angle[v], d.edge.angle[e]);
      d.vertex.curvature[v] = std::max(d.vertex.curvature[v], d.edge.curvature[e]);
    }
  for (Eigen::Index v = 0; v < n; ++v) {
    if (rims[v][0] < 0) continue;
    Eigen::Vector3d along[2];
    for (int k = 0; k < 2; ++k) {
      const auto edge = surface.edges.row(rims[v][k]);
      along[k] = (vertices.row(edge[edge[0] == v]) - vertices.row(v)).transpose();
    }
    const double angle = std::atan2(along[0].cross(along[1]).norm(), -along[0].dot(along[1]));
    if (angle < flat_angle) continue;
    d.vertex.angle[v] = std::max(d.vertex.angle[v], angle);
    d.vertex.curvature[v] = std::max(d.vertex.curvature[v], 2 * angle / (along[0].norm() + along[1].norm()));
  }
  return d;
}

OperatorCoefficients OperatorCoefficients::of(const Surface& surface, const Dihedrals& dihedrals,
                                              double dhat) {
  constexpr double full = 0.25, none = 1;  // largest curvature with coefficient 1, smallest with 0 [1/d̂]
  const Eigen::Index n = dihedrals.vertex.angle.size(), count = surface.edges.rows();
  OperatorCoefficients c;
  c.edge.setZero(count);
  c.vertex.setConstant(n, -1);                       // at a vertex of single triangles no edge reduces it
  std::vector<int> further(count, -1), euler(n, 1);  // triangles of an edge beyond one
  for (int t = 0; t < surface.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) {
      ++further[surface.triangle_edges(t, k)];
      --euler[surface.triangles(t, k)];
    }
  for (int e = 0; e < count; ++e) {
    if (further[e] == 0) continue;
    const double reduction = (dhat * dihedrals.edge.curvature[e] - full) / (none - full);
    const double part = 1 - std::clamp(reduction, 0.0, 1.0);
    c.edge[e] = further[e] * part;
    for (int k = 0; k < 2; ++k) {
      const int v = surface.edges(e, k);
      euler[v] += further[e];
      c.vertex[v] = std::max(c.vertex[v], part);
    }
  }
  for (Eigen::Index v = 0; v < n; ++v)
    c.vertex[v] = c.vertex[v] < 0 ? std::min(euler[v], 0) : c.vertex[v] * euler[v];
  return c;
}

}  // namespace drape
