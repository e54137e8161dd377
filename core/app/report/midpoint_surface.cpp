#include "core/app/report/midpoint_surface.h"

#include <Eigen/Geometry>

#include "core/kernel/interfaces/topology.h"

namespace drape {

bool split_to(Eigen::Index count, const Triangles& finest, const TrianglesOfLevel& triangles_of,
              TriangleMesh& mesh, Positions& normals) {
  while (mesh.vertices.rows() < count) {
    const int n = static_cast<int>(mesh.vertices.rows());
    const Topology topology = Topology::of(mesh.triangles, n);
    const Eigen::Index next = n + topology.edges.rows();
    const Triangles* triangles = next == count ? &finest : triangles_of(next);
    if (next > count || !triangles) return false;
    mesh.vertices.conservativeResize(next, 3);
    normals.conservativeResize(next, 3);
    for (Eigen::Index e = 0; e < topology.edges.rows(); ++e) {
      const int a = topology.edges(e, 0), b = topology.edges(e, 1);
      mesh.vertices.row(n + e) = (mesh.vertices.row(a) + mesh.vertices.row(b)) / 2;
      normals.row(n + e) = (normals.row(a) + normals.row(b)).normalized();
    }
    mesh.triangles = *triangles;
  }
  return mesh.vertices.rows() == count;
}

}  // namespace drape
