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

SurfaceTopology::SurfaceTopology(const Triangles& all, const Topology& topology)
    : triangles(all),
      triangle_edges(topology.triangle_edges),
      edges(topology.edges),
      vertex_corner(topology.on_border.size(), -1),
      edge_corner(edges.rows(), -1),
      represented(all.rows(), 0) {
  for (int t = 0; t < triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int v = triangles(t, k), e = triangle_edges(t, k);
      const bool of_vertex = topology.vertex_triangles.row(v).front() == t,
                 of_edge = topology.edge_triangles(e, 0) == t;
      if (of_vertex) vertex_corner[v] = 3 * t + k;
      if (of_edge) edge_corner[e] = 3 * t + k;
      represented[t] |= static_cast<unsigned char>(int(of_vertex) << k | int(of_edge) << (3 + k));
    }
}

void SurfaceTopology::append(const SurfaceTopology& other) {
  const int n = vertex_count(), e = static_cast<int>(edges.rows()), t = triangle_count();
  append_rows(triangles, Triangles(other.triangles.array() + n));
  append_rows(triangle_edges, Triangles(other.triangle_edges.array() + e));
  append_rows(edges, decltype(edges)(other.edges.array() + n));
  for (const int corner : other.vertex_corner) vertex_corner.push_back(3 * t + corner);
  for (const int corner : other.edge_corner) edge_corner.push_back(3 * t + corner);
  represented.insert(represented.end(), other.represented.begin(), other.represented.end());
}

Surface Surface::of(const TriangleMesh& rest, const Topology& topology) {
  Surface s{{rest.triangles, topology}, {}, {}, {}, {}};
  s.vertex_area.setZero(rest.vertices.rows());
  s.edge_area.setZero(s.edges.rows());
  s.triangle_area.resize(rest.triangles.rows());
  for (int t = 0; t < s.triangle_count(); ++t) {
    const Eigen::Matrix3d x = rest_corners(rest, t);
    s.triangle_area[t] = 0.5 * (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).norm();
    for (int k = 0; k < 3; ++k) {
      s.vertex_area[s.triangles(t, k)] += s.triangle_area[t] / 3;
      s.edge_area[s.triangle_edges(t, k)] += s.triangle_area[t] / 3;
    }
  }
  s.edge_length_squared.resize(s.edges.rows());
  for (int e = 0; e < s.edges.rows(); ++e) {
    const RestSide side = rest_side(rest, topology, e, 0);
    s.edge_length_squared[e] = (side.to - side.from).squaredNorm();
  }
  return s;
}

void SweptBoxes::update(const Positions& x0, const Positions& x1, double margin,
                        const Eigen::RowVector3d& origin) {
  vertices.resize(x0.rows());
  triangles.resize(surface.triangle_count());
  parallel_for(static_cast<int>(vertices.size()), 4096, [&](int begin, int end) {
    for (int v = begin; v < end; ++v)
      vertices[v] = Box::around(x0.row(v) - origin, x1.row(v) - origin, margin);
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
