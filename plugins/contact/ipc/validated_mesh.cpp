#include "plugins/contact/ipc/validated_mesh.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/kernel/mesh/check.h"
#include "core/kernel/mesh/io.h"
#include "core/kernel/mesh/same_triangles.h"

namespace drape::ipc {
namespace {

namespace fs = std::filesystem;

TriangleMesh box() {
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
  fine.triangles.resize(4 * coarse.triangles.rows(), 3);
  for (int t = 0; t < coarse.triangles.rows(); ++t) {
    const auto v = coarse.triangles.row(t);
    const Eigen::RowVector3i e = topology.triangle_edges.row(t).array() + n;
    fine.triangles.middleRows<4>(4 * t) << v[0], e[2], e[1], v[1], e[0], e[2], v[2], e[1], e[0], e[0], e[1],
        e[2];
  }
  return fine;
}

bool same_mesh(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices.rows() == b.vertices.rows() && a.vertices == b.vertices &&
         same_triangles(a.triangles, b.triangles);
}

}  // namespace

std::shared_ptr<const ValidatedMesh> ValidatedMesh::of(TriangleMesh mesh) {
  Topology topology = Topology::of(mesh.triangles, static_cast<int>(mesh.vertices.rows()));
  return std::make_shared<const ValidatedMesh>(ValidatedMesh{std::move(mesh), std::move(topology)});
}

bool are_equal(const ValidatedMeshes& a, const ValidatedMeshes& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& one, const auto& other) {
    return one == other || same_mesh(one->mesh, other->mesh);
  });
}

std::shared_ptr<const ValidatedMesh> load_validated_mesh(const fs::path& file) {
  TriangleMesh mesh = read_mesh(file);
  if (const auto faults = check_mesh(mesh); !faults.empty())
    throw std::runtime_error(file.string() + ": " + faults[0]);
  return ValidatedMesh::of(std::move(mesh));
}

std::shared_ptr<const ValidatedMesh> unit_box() { return ValidatedMesh::of(box()); }

std::shared_ptr<const ValidatedMesh> unit_sphere(int subdivisions) {
  TriangleMesh mesh = icosahedron();
  for (int i = 0; i < subdivisions; ++i) mesh = split_on_sphere(mesh);
  return ValidatedMesh::of(std::move(mesh));
}

}  // namespace drape::ipc
