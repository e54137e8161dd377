#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/kernel/interfaces/topology.h"
#include "core/numerics/mesh/repair.h"
#include "core/numerics/mesh_files/file_coordinates.h"

namespace drape::ipc {

/// A mesh that contact can take (repair_mesh), in local coordinates. Obstacles under different loads share
/// it.
struct ValidatedMesh {
  TriangleMesh mesh;
  Topology topology;

  /// Of a repaired mesh.
  static std::shared_ptr<const ValidatedMesh> of(TriangleMesh mesh);
};

using ValidatedMeshes = std::vector<std::shared_ptr<const ValidatedMesh>>;
/// Whether they are the same objects, or have the same vertices and triangles.
bool are_equal(const ValidatedMeshes& a, const ValidatedMeshes& b);

/// The meshes of an obstacle's files, and how they were repaired.
struct LoadedMeshes {
  ValidatedMeshes meshes;
  MeshRepair repair;
};
/// Reads one mesh file, or the frames of an animation, converts their coordinates, and repairs them together.
/// A `strict` obstacle is not repaired. Throws RefusedParameters or std::runtime_error naming the files and
/// their faults.
LoadedMeshes load_validated_meshes(const std::vector<std::string>& files, const FileCoordinates& coordinates,
                                   bool strict);
/// unit_box and unit_sphere of core/numerics/patterns/primitives.h.
std::shared_ptr<const ValidatedMesh> validated_box();
std::shared_ptr<const ValidatedMesh> validated_sphere(int subdivisions);

}  // namespace drape::ipc
