#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/topology.h"
#include "core/numerics/mesh/same_entries.h"

namespace drape::ipc {

/// A mesh that contact can take (repair_mesh), in local coordinates. Obstacles under different loads share
/// it.
struct ValidatedMesh {
  TriangleMesh mesh;
  Topology topology;

  /// `mesh` must have been repaired (repair_mesh).
  static std::shared_ptr<const ValidatedMesh> of(TriangleMesh mesh) {
    Topology topology = Topology::of_any(mesh.triangles, static_cast<int>(mesh.vertices.rows()));
    return std::make_shared<const ValidatedMesh>(ValidatedMesh{std::move(mesh), std::move(topology)});
  }
};

using ValidatedMeshes = std::vector<std::shared_ptr<const ValidatedMesh>>;

/// Whether they are the same objects, or have the same vertices and triangles.
inline bool are_equal(const ValidatedMeshes& a, const ValidatedMeshes& b) {
  return std::ranges::equal(a, b, [](const auto& one, const auto& other) {
    return one == other || (same_entries(one->mesh.vertices, other->mesh.vertices) &&
                            same_entries(one->mesh.triangles, other->mesh.triangles));
  });
}

}  // namespace drape::ipc
