#pragma once

#include <filesystem>
#include <memory>

#include "core/kernel/mesh/topology.h"

namespace drape::ipc {

/// A mesh that has passed check_mesh, in local coordinates. Obstacles that are rebuilt as loads change share
/// it.
struct ValidatedMesh {
  TriangleMesh mesh;
  Topology topology;
};

// All are cached for as long as anyone owns the mesh. Throw std::runtime_error with the fault.

/// Reads a file. The cache compares path, size and modification time.
std::shared_ptr<const ValidatedMesh> load_validated_mesh(const std::filesystem::path& file);
/// Edge length 1 m, centred at the origin, with outward normals.
std::shared_ptr<const ValidatedMesh> unit_box();
/// An icosphere of radius 1 m: a subdivided icosahedron with its vertices on the sphere.
std::shared_ptr<const ValidatedMesh> unit_sphere(int subdivisions);

}  // namespace drape::ipc
