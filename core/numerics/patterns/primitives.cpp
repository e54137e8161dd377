#include <cmath>

#include "core/numerics/mesh/split_triangles.h"
#include "core/numerics/patterns/generate.h"

namespace drape {
namespace {

TriangleMesh icosahedron() {
  const double a = 1, b = (1 + std::sqrt(5.0)) / 2;
  TriangleMesh mesh;
  mesh.vertices.resize(12, 3);
  mesh.vertices << -a, b, 0, a, b, 0, -a, -b, 0, a, -b, 0, 0, -a, b, 0, a, b, 0, -a, -b, 0, a, -b, b, 0, -a,
      b, 0, a, -b, 0, -a, -b, 0, a;
  mesh.triangles.resize(20, 3);
  mesh.triangles << 0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4, 11, 10, 2, 10, 7, 6,
      7, 1, 8, 3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5, 2, 4, 11, 6, 2, 10, 8, 6, 7, 9, 8, 1;
  mesh.vertices.rowwise().normalize();
  return mesh;
}

/// Splits every triangle in four and projects new vertices onto the unit sphere.
TriangleMesh split_on_sphere(const TriangleMesh& coarse) {
  const int n = static_cast<int>(coarse.vertices.rows());
  const Topology topology = Topology::of(coarse.triangles, n);
  TriangleMesh fine;
  fine.vertices.resize(n + topology.edges.rows(), 3);
  fine.vertices.topRows(n) = coarse.vertices;
  for (int e = 0; e < topology.edges.rows(); ++e)
    fine.vertices.row(n + e) =
        (coarse.vertices.row(topology.edges(e, 0)) + coarse.vertices.row(topology.edges(e, 1))).normalized();
  fine.triangles = split_triangles(coarse.triangles, topology);
  // Each corner's triangle begins at the corner: the edges' order, and with it that of contacts, depends on
  // it.
  for (int t = 0; t < coarse.triangles.rows(); ++t)
    for (int k = 1; k < 3; ++k) {
      const Eigen::RowVector3i v = fine.triangles.row(4 * t + k);
      fine.triangles.row(4 * t + k) << v[k], v[(k + 1) % 3], v[(k + 2) % 3];
    }
  return fine;
}

}  // namespace

TriangleMesh unit_box() {
  TriangleMesh mesh;
  mesh.vertices.resize(8, 3);
  for (int v = 0; v < 8; ++v)
    for (int k = 0; k < 3; ++k) mesh.vertices(v, k) = (v >> k & 1) - 0.5;
  mesh.triangles.resize(12, 3);
  mesh.triangles << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6,  // z
      0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3,                // y
      0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5;                // x
  return mesh;
}

TriangleMesh unit_sphere(int subdivisions) {
  TriangleMesh mesh = icosahedron();
  for (int i = 0; i < subdivisions; ++i) mesh = split_on_sphere(mesh);
  return mesh;
}

}  // namespace drape
