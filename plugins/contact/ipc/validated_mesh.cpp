#include "plugins/contact/ipc/validated_mesh.h"

#include <algorithm>
#include <stdexcept>

#include "core/kernel/linear_algebra/same_entries.h"
#include "core/kernel/mesh/check.h"
#include "core/kernel/mesh/io.h"
#include "core/kernel/mesh/primitives.h"

namespace drape::ipc {
namespace {

namespace fs = std::filesystem;

bool same_mesh(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices.rows() == b.vertices.rows() && a.vertices == b.vertices &&
         same_entries(a.triangles, b.triangles);
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

std::shared_ptr<const ValidatedMesh> validated_box() { return ValidatedMesh::of(unit_box()); }

std::shared_ptr<const ValidatedMesh> validated_sphere(int subdivisions) {
  return ValidatedMesh::of(unit_sphere(subdivisions));
}

}  // namespace drape::ipc
