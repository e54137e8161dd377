#include "core/numerics/collision_detection/surface.h"

#include <Eigen/Geometry>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/mesh/seams.h"

namespace drape {
namespace {

template <class Rows>
void append_rows(Rows& rows, const Rows& more) {
  const Eigen::Index count = rows.rows();
  rows.conservativeResize(count + more.rows(), Eigen::NoChange);
  rows.bottomRows(more.rows()) = more;
}

}  // namespace

Surface Surface::of(const TriangleMesh& rest, const Topology& topology) {
  Surface s;
  s.triangles = rest.triangles;
  s.triangle_edges = topology.triangle_edges;
  s.edges = topology.edges;
  s.vertex_corner.assign(rest.vertices.rows(), -1);
  s.edge_corner.assign(s.edges.rows(), -1);
  s.vertex_area.setZero(rest.vertices.rows());
  s.edge_area.setZero(s.edges.rows());
  s.triangle_area.resize(rest.triangles.rows());
  for (int t = 0; t < s.triangle_count(); ++t) {
    const Eigen::Matrix3d x = rest_corners(rest, t);
    s.triangle_area[t] = 0.5 * (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).norm();
    for (int k = 0; k < 3; ++k) {
      const int v = s.triangles(t, k), e = s.triangle_edges(t, k);
      s.vertex_area[v] += s.triangle_area[t] / 3;
      s.edge_area[e] += s.triangle_area[t] / 3;
      if (topology.vertex_triangles.row(v).front() == t) s.vertex_corner[v] = 3 * t + k;
      if (topology.edge_triangles(e, 0) == t) s.edge_corner[e] = 3 * t + k;
    }
  }
  s.edge_length_squared.resize(s.edges.rows());
  for (int e = 0; e < s.edges.rows(); ++e) {
    const RestSide side = rest_side(rest, topology, e, 0);
    s.edge_length_squared[e] = (side.to - side.from).squaredNorm();
  }
  return s;
}

void Surface::append(const Surface& other) {
  const int n = static_cast<int>(vertex_area.size()), e = static_cast<int>(edges.rows()),
            t = triangle_count();
  append_rows(triangles, Triangles(other.triangles.array() + n));
  append_rows(triangle_edges, Triangles(other.triangle_edges.array() + e));
  append_rows(edges, decltype(edges)(other.edges.array() + n));
  for (const int corner : other.vertex_corner) vertex_corner.push_back(3 * t + corner);
  for (const int corner : other.edge_corner) edge_corner.push_back(3 * t + corner);
  append_rows(vertex_area, other.vertex_area);
  append_rows(edge_area, other.edge_area);
  append_rows(triangle_area, other.triangle_area);
  append_rows(edge_length_squared, other.edge_length_squared);
}

void SweptBoxes::update(const Positions& x0, const Positions& x1, double margin,
                        const Eigen::RowVector3d& origin) {
  vertices.resize(x0.rows());
  edges.resize(surface.edges.rows());
  triangles.resize(surface.triangle_count());
  parallel_for(static_cast<int>(vertices.size()), 4096, [&](int begin, int end) {
    for (int v = begin; v < end; ++v)
      vertices[v] = Box::around(x0.row(v) - origin, x1.row(v) - origin, margin);
  });
  parallel_for(static_cast<int>(edges.size()), 4096, [&](int begin, int end) {
    for (int e = begin; e < end; ++e) {
      edges[e] = vertices[surface.edges(e, 0)];
      edges[e].include(vertices[surface.edges(e, 1)]);
    }
  });
  parallel_for(surface.triangle_count(), 4096, [&](int begin, int end) {
    for (int t = begin; t < end; ++t) {
      triangles[t] = vertices[surface.triangles(t, 0)];
      triangles[t].include(vertices[surface.triangles(t, 1)]);
      triangles[t].include(vertices[surface.triangles(t, 2)]);
    }
  });
}

}  // namespace drape
