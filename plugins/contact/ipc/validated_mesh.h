#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "core/kernel/mesh/topology.h"

namespace drape::ipc {

/// A mesh that has passed check_mesh, in local coordinates. Obstacles under different loads share it.
struct ValidatedMesh {
  TriangleMesh mesh;
  Topology topology;

  /// Of a mesh that has passed check_mesh.
  static std::shared_ptr<const ValidatedMesh> of(TriangleMesh mesh);
};

using ValidatedMeshes = std::vector<std::shared_ptr<const ValidatedMesh>>;
/// Whether they are the same objects, or have the same vertices and triangles.
bool are_equal(const ValidatedMeshes& a, const ValidatedMeshes& b);

/// Reads and checks a mesh file. Throws std::runtime_error naming the file and its first fault.
std::shared_ptr<const ValidatedMesh> load_validated_mesh(const std::filesystem::path& file);
/// unit_box and unit_sphere of core/kernel/mesh/primitives.h.
std::shared_ptr<const ValidatedMesh> validated_box();
std::shared_ptr<const ValidatedMesh> validated_sphere(int subdivisions);

}  // namespace drape::ipc
