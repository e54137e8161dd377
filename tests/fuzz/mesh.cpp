// A mesh file of any format; the first byte chooses which: P for PLY, S for STL, o for OBJ, O for OFF;
// its highest bit reads the surface alone.

#include <cstdint>
#include <stdexcept>

#include "core/numerics/mesh/check.h"
#include "core/numerics/mesh_files/io_formats.h"
#include "tests/fuzz/require.h"

namespace {

using namespace drape;

TriangleMesh read(char format, std::string_view bytes, MeshUse use) {
  int lines = 0;
  if (format == 'o') return read_obj("fuzz.obj", bytes, use, lines);
  if (format == 'O') return read_off("fuzz.off", bytes, use);
  if (format == 'S') return read_stl("fuzz.stl", bytes);
  return read_ply("fuzz.ply", bytes, use, lines);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const MeshUse use = data[0] & 0x80 ? MeshUse::surface : MeshUse::cloth;
    const TriangleMesh mesh = read(static_cast<char>(data[0] & 0x7f), bytes, use);
    require(mesh.triangles.size() == 0 ||
                (mesh.triangles.minCoeff() >= 0 && mesh.triangles.maxCoeff() < mesh.vertices.rows()),
            "a triangle names a vertex that is not there");
    require(mesh.vertices.allFinite(), "a coordinate is not finite");
    if (!check_mesh(mesh).empty()) return 0;
    int lines = 0;
    const TriangleMesh again = read_obj("again.obj", obj_text(mesh), use, lines);
    require(again.vertices == mesh.vertices && again.triangles == mesh.triangles,
            "written and read is not the same");
  } catch (const std::runtime_error& error) {
    require(std::string_view(error.what()).starts_with("fuzz."), error.what());
  }
  return 0;
}
