#pragma once

#include <bit>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/numerics/mesh_files/io.h"

namespace drape {

static_assert(std::endian::native == std::endian::little, "binary formats hold numbers as memory does");

// The formats behind read_mesh and write_mesh; bytes are a file's whole contents, the path is for errors.

TriangleMesh read_obj(const std::filesystem::path& path, std::string_view bytes);
TriangleMesh read_off(const std::filesystem::path& path, std::string_view bytes);
TriangleMesh read_stl(const std::filesystem::path& path, std::string_view bytes);
TriangleMesh read_ply(const std::filesystem::path& path, std::string_view bytes);
std::string obj_text(const TriangleMesh& mesh);
std::string ply_bytes(const TriangleMesh& mesh, const VertexFields& fields = {});
std::string vtp_text(const TriangleMesh& mesh, const VertexFields& fields = {});
/// A ParaView collection: time [s] and a .vtp path relative to the collection, one pair per frame.
std::string pvd_text(const std::vector<std::pair<double, std::string>>& frames);

/// Throws std::runtime_error unless every field has n values and a name of its own without white space,
/// other than x, y and z.
void require_fields(const std::filesystem::path& path, const TriangleMesh& mesh, const VertexFields& fields);

}  // namespace drape
