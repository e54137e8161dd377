// PLY out: binary little endian, double.
#include <cstdint>

#include "core/kernel/files/file.h"
#include "core/kernel/files/number_text.h"
#include "core/numerics/mesh_files/io.h"

namespace drape {

std::string ply_bytes(const TriangleMesh& mesh, const VertexFields& fields) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& name : mesh.piece_names) bytes += "comment piece " + name + "\n";
  if (mesh.sewing) bytes += "comment uv_length " + exact_text(mesh.sewing->uv_length) + "\n";
  bytes += "element vertex " + std::to_string(mesh.vertices.rows()) +
           "\nproperty double x\nproperty double y\nproperty double z\n";
  for (const VertexField& field : fields) bytes += "property double " + field.name + "\n";
  bytes +=
      "element face " + std::to_string(mesh.triangles.rows()) + "\nproperty list uchar int vertex_indices\n";
  const bool with_uv = mesh.uv.rows() > 0;
  if (with_uv) bytes += "property list uchar double texcoord\n";
  const bool with_warp = mesh.warp.rows() > 0;
  if (with_warp) bytes += "property double warp_x\nproperty double warp_y\nproperty double warp_z\n";
  const bool with_piece = !mesh.piece.empty();
  if (with_piece) bytes += "property int piece\n";
  bytes += "end_header\n";
  const auto append = [&](auto number) { append_bytes(bytes, number); };
  for (int v = 0; v < mesh.vertices.rows(); ++v) {
    for (int k = 0; k < 3; ++k) append(mesh.vertices(v, k));
    for (const VertexField& field : fields) append(field.values[v]);
  }
  for (int t = 0; t < mesh.triangles.rows(); ++t) {
    append(std::uint8_t{3});
    for (int k = 0; k < 3; ++k) append(std::int32_t{mesh.triangles(t, k)});
    if (with_uv) append(std::uint8_t{6});
    for (int k = 0; with_uv && k < 6; ++k) append(mesh.uv(t, k));
    for (int k = 0; with_warp && k < 3; ++k) append(mesh.warp(t, k));
    if (with_piece) append(std::int32_t{mesh.piece[t]});
  }
  return bytes;
}

}  // namespace drape
