#include "core/app/report/run_file.h"

#include "core/kernel/files/file.h"
#include "core/numerics/mesh_files/io_formats.h"

namespace drape {

RunFile RunFile::of(const JsonFile& results, const Json& record, const char* key, const char* checksum_key) {
  if (text_member(record, key).empty()) return {};
  return {results.inside(record, key), results.find<std::uint32_t>(record, checksum_key)};
}

bool RunFile::exists() const {
  std::error_code none;
  return is_named() && std::filesystem::is_regular_file(path, none);
}

bool RunFile::fits(std::string_view bytes) const { return !checksum || checksum_of(bytes) == *checksum; }

std::string RunFile::bytes() const {
  std::string all = read_file(path);
  if (!fits(all)) refuse_path(path, "is damaged: its checksum does not fit");
  return all;
}

TriangleMesh RunFile::mesh() const {
  int lines = 0;
  return read_ply(path, bytes(), MeshUse::cloth, lines);
}

VertexFields RunFile::fields() const { return ply_fields(path, bytes()); }

}  // namespace drape
