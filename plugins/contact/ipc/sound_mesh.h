#pragma once

#include <filesystem>
#include <memory>

#include "core/mesh/topology.h"

namespace drape {

/// A mesh that has passed check_mesh, in its own coordinates. Obstacles that are made again and again, as
/// conditions change, share it.
struct SoundMesh {
  TriangleMesh mesh;
  Topology topology;
};

// All keep what they made, by file (path, size and time of change) or dimensions, for as long as somebody has
// it. All throw std::runtime_error with what is wrong.

std::shared_ptr<const SoundMesh> sound_mesh_of(const std::filesystem::path& file);
/// Edges of 1 m about the origin, triangles facing outwards.
std::shared_ptr<const SoundMesh> unit_box();
/// Radius 1 m: an icosahedron whose triangles are cut in four so often, vertices on the sphere.
std::shared_ptr<const SoundMesh> unit_sphere(int subdivisions);

}  // namespace drape
