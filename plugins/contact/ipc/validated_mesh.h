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
/// unit_box and unit_sphere of core/kernel/mesh/primitives.h.
std::shared_ptr<const ValidatedMesh> validated_box();
std::shared_ptr<const ValidatedMesh> validated_sphere(int subdivisions);

}  // namespace drape::ipc
