#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/kernel/interfaces/triangle_mesh.h"
#include "core/numerics/mesh/mesh_builder.h"

namespace drape {

// The formats behind read_mesh and write_mesh; bytes are a file's whole contents, the path is for errors. The
// number of lines between vertices, which are not part of the mesh, is added to `lines`.

TriangleMesh read_obj(const std::filesystem::path& path, std::string_view bytes, MeshUse use, int& lines);
TriangleMesh read_off(const std::filesystem::path& path, std::string_view bytes, MeshUse use);
TriangleMesh read_ply(const std::filesystem::path& path, std::string_view bytes, MeshUse use, int& lines);
/// read_ply_fields of the bytes.
VertexFields ply_fields(const std::filesystem::path& path, std::string_view bytes);
TriangleMesh read_stl(const std::filesystem::path& path, std::string_view bytes);
std::string obj_text(const TriangleMesh& mesh);

}  // namespace drape
