#include "core/numerics/mesh_files/io.h"

#include <boost/algorithm/string/case_conv.hpp>
#include <stdexcept>

#include "core/kernel/files/file.h"
#include "core/numerics/mesh_files/io_formats.h"

namespace drape {
namespace {

std::runtime_error unknown_extension(const std::filesystem::path& path, const std::string& known) {
  return std::runtime_error(path.string() + ": unknown mesh format '" + path.extension().string() +
                            "'; known are " + known);
}

TriangleMesh read(const std::filesystem::path& path, MeshUse use, int& lines) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return read_obj(path, read_file(path), use, lines);
  if (extension == ".off") return read_off(path, read_file(path), use);
  if (extension == ".ply") return read_ply(path, read_file(path), use, lines);
  if (extension == ".stl") return read_stl(path, read_file(path));
  throw unknown_extension(path, ".obj, .off, .ply, .stl");
}

}  // namespace

std::string lower_extension(const std::filesystem::path& path) {
  return boost::to_lower_copy(path.extension().string());
}

TriangleMesh read_mesh(const std::filesystem::path& path) {
  int lines = 0;
  return read(path, MeshUse::cloth, lines);
}

TriangleMesh read_surface(const std::filesystem::path& path) {
  int lines = 0;
  return read(path, MeshUse::surface, lines);
}

int line_elements_in(const std::filesystem::path& path) {
  int lines = 0;
  read(path, MeshUse::surface, lines);
  return lines;
}

void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh) {
  const std::string extension = lower_extension(path);
  if (extension == ".ply") return write_file(path, ply_bytes(mesh));
  if (extension == ".obj") return write_file(path, obj_text(mesh));
  throw unknown_extension(path, ".obj, .ply");
}

}  // namespace drape
