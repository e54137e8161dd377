#pragma once

#include <string>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"
#include "core/numerics/mesh/texture_coordinates.h"

namespace drape {

/// One state of a surface.
struct GltfState {
  Positions positions;  ///< n×3 [m], z upwards
  Positions normals;    ///< n×3, of length 1
};

enum class GltfMaterial { cloth, obstacle };

/// A surface of a glTF file.
struct GltfSurface {
  std::string name;
  GltfMaterial material = GltfMaterial::cloth;
  Triangles triangles;  ///< m×3, m > 0
  GltfState state;
  UvVertices::Coordinates uv;           ///< n×2, v upwards; may be empty
  std::vector<GltfState> earlier = {};  ///< states before `state`, which an animation shows; may be empty
  double uv_length = 0;                 ///< of a unit of uv in flat pieces [m]; 0: none
  std::vector<int> piece = {};          ///< m indices of piece_names; or empty
  std::vector<std::string> piece_names = {};
};

/// A scene: the surfaces that it shows, by index.
struct GltfScene {
  std::string name;
  std::vector<int> surfaces;
};

/// A binary glTF 2.0 file (Khronos Group, "glTF 2.0 Specification", ISO/IEC 12113). The last scene is the one
/// that viewers show. Axes become glTF's: y upwards, v downwards. Texture coordinates that span more than 10,
/// as in millimetres, begin at 0 and are scaled to 1 at most, both by the mesh's `extras.texcoordScale`.
/// Earlier states are morph targets of an animation that ends with `state`. Each piece is a primitive with a
/// material of its name. Throws std::runtime_error beyond 4 GiB, which the format cannot hold.
std::string glb_bytes(const std::vector<GltfSurface>& surfaces, const std::vector<GltfScene>& scenes);

}  // namespace drape
