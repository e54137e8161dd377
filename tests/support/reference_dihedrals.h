#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/numerics/collision_detection/dihedrals.h"

/// The bends of all edges and vertices of a surface in passes over its triangles and edges, which share no
/// code with Dihedrals.
struct ReferenceDihedrals {
  std::vector<drape::Bend> edge, vertex;
  std::vector<char> edge_is_rim;
  std::vector<int> further, euler;  ///< triangles of each edge beyond one; the vertices' whole coefficients

  static ReferenceDihedrals of(const drape::SurfaceTopology& surface, const drape::Positions& vertices) {
    ReferenceDihedrals d;
    d.set_edges(surface, vertices);
    d.set_vertices(surface, vertices);
    d.set_rims(surface, vertices);
    return d;
  }

  /// What is left of an edge's coefficient.
  double part(int e, double dhat) const {
    return 1 - std::clamp((dhat * edge[e].curvature - 0.25) / 0.75, 0.0, 1.0);
  }
  double edge_coefficient(int e, double dhat) const { return further[e] * part(e, dhat); }
  std::vector<double> vertex_coefficients(const drape::SurfaceTopology& surface, double dhat) const {
    std::vector<double> all(vertex.size(), -1);
    for (int e = 0; e < surface.edges.rows(); ++e)
      for (int k = 0; k < 2 && further[e] != 0; ++k)
        all[surface.edges(e, k)] = std::max(all[surface.edges(e, k)], part(e, dhat));
    for (std::size_t v = 0; v < all.size(); ++v)
      all[v] = all[v] < 0 ? std::min(euler[v], 0) : all[v] * euler[v];
    return all;
  }

 private:
  void set_edges(const drape::SurfaceTopology& surface, const drape::Positions& x) {
    const Eigen::Index count = surface.edges.rows();
    edge.resize(count);
    vertex.resize(x.rows());
    further.assign(count, -1);
    euler.assign(x.rows(), 1);
    std::vector<std::array<Eigen::RowVector3d, 2>> height(count);
    std::vector<double> least(count, std::numeric_limits<double>::infinity());
    for (int t = 0; t < surface.triangle_count(); ++t) {
      const auto corner = [&](int k) -> Eigen::RowVector3d { return x.row(surface.triangles(t, k)); };
      const double area = 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
      for (int k = 0; k < 3; ++k) {
        const int e = surface.triangle_edges(t, k);
        const Eigen::RowVector3d from = x.row(surface.edges(e, 0)), along = x.row(surface.edges(e, 1)) - from,
                                 to = corner(k) - from;
        Eigen::RowVector3d& own = height[e][++further[e] > 0];
        own = to - to.dot(along) / along.squaredNorm() * along;
        least[e] = std::min(least[e], own.norm());
        edge[e].area += area / 3;
        vertex[surface.triangles(t, k)].area += area / 3;
        --euler[surface.triangles(t, k)];
      }
    }
    for (int e = 0; e < count; ++e) {
      const auto& [a, b] = height[e];
      double& angle = edge[e].angle;
      angle = further[e] == 1 ? std::atan2(a.cross(b).norm(), -a.dot(b)) : M_PI;
      if (angle < 1e-6) angle = 0;
      if (further[e] == 1) edge[e].curvature = 2 * angle / (a.norm() + b.norm());
      if (further[e] > 1) edge[e].curvature = M_PI / least[e];
      edge_is_rim.push_back(angle > M_PI / 6);
    }
  }

  void set_vertices(const drape::SurfaceTopology& surface, const drape::Positions& x) {
    rims_.assign(x.rows(), {});
    for (int e = 0; e < surface.edges.rows(); ++e)
      for (int k = 0; k < 2; ++k) {
        euler[surface.edges(e, k)] += further[e];
        if (edge_is_rim[e]) rims_[surface.edges(e, k)].push_back(e);
      }
    for (int e = 0; e < surface.edges.rows(); ++e)
      for (int k = 0; k < 2; ++k) {
        const int v = surface.edges(e, k);
        if (rims_[v].size() == 2 && std::ranges::count(rims_[v], e) > 0) continue;
        vertex[v].angle = std::max(vertex[v].angle, edge[e].angle);
        vertex[v].curvature = std::max(vertex[v].curvature, edge[e].curvature);
      }
  }

  void set_rims(const drape::SurfaceTopology& surface, const drape::Positions& x) {
    for (int v = 0; v < x.rows(); ++v) {
      if (rims_[v].size() != 2) continue;
      Eigen::Vector3d along[2];
      for (int k = 0; k < 2; ++k) {
        const auto ends = surface.edges.row(rims_[v][k]);
        along[k] = x.row(ends[0] == v ? ends[1] : ends[0]) - x.row(v);
      }
      const double angle = std::atan2(along[0].cross(along[1]).norm(), -along[0].dot(along[1]));
      if (angle < 1e-6) continue;
      vertex[v].angle = std::max(vertex[v].angle, angle);
      vertex[v].curvature = std::max(vertex[v].curvature, 2 * angle / (along[0].norm() + along[1].norm()));
    }
  }

  std::vector<std::vector<int>> rims_;  // of each vertex
};
