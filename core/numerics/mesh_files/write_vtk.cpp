// VTK XML PolyData and ParaView collections, as in "VTK XML Formats" (Kitware): inline base64 of a
// UInt64 byte count and the data, in one piece.
#include <cstdint>

#include "core/kernel/files/number_text.h"
#include "core/numerics/mesh_files/base64.h"
#include "core/numerics/mesh_files/io.h"

namespace drape {
namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text)
    result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
  return result;
}

template <class Number>
std::string data_array(const std::string& attributes, const Number* values, Eigen::Index count) {
  const std::uint64_t size = static_cast<std::uint64_t>(count) * sizeof(Number);
  std::string bytes(reinterpret_cast<const char*>(&size), sizeof size);
  if (size > 0) bytes.append(reinterpret_cast<const char*>(values), size);
  return "<DataArray " + attributes + " format=\"binary\">" + base64(bytes) + "</DataArray>\n";
}

std::string file_head(const std::string& type) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + type +
         "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n";
}

/// The number of the piece of each polygon.
std::string piece_data(const TriangleMesh& mesh) {
  if (mesh.piece.empty()) return "";
  const std::vector<std::int64_t> numbers(mesh.piece.begin(), mesh.piece.end());
  return "<CellData>\n" + data_array("type=\"Int64\" Name=\"piece\"", numbers.data(), std::ssize(numbers)) +
         "</CellData>\n";
}

}  // namespace

std::string vtp_text(const TriangleMesh& mesh, const VertexFields& fields) {
  const Eigen::Index n = mesh.vertices.rows(), m = mesh.triangles.rows();
  std::string text = file_head("PolyData") + "<PolyData>\n<Piece NumberOfPoints=\"" + std::to_string(n) +
                     "\" NumberOfPolys=\"" + std::to_string(m) + "\">\n<PointData>\n";
  for (const VertexField& field : fields)
    text += data_array("type=\"Float64\" Name=\"" + escaped(field.name) + "\"", field.values.data(), n);
  text += "</PointData>\n<Points>\n" + data_array("type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"",
                                                  mesh.vertices.data(), 3 * n);
  const Eigen::Matrix<std::int64_t, Eigen::Dynamic, 3, Eigen::RowMajor> corners =
      mesh.triangles.cast<std::int64_t>();
  const auto ends = Eigen::Matrix<std::int64_t, Eigen::Dynamic, 1>::LinSpaced(m, 3, 3 * m).eval();
  text += "</Points>\n<Polys>\n" + data_array("type=\"Int64\" Name=\"connectivity\"", corners.data(), 3 * m) +
          data_array("type=\"Int64\" Name=\"offsets\"", ends.data(), m) + "</Polys>\n" + piece_data(mesh) +
          "</Piece>\n</PolyData>\n</VTKFile>\n";
  return text;
}

std::string pvd_text(const std::vector<std::pair<double, std::string>>& frames) {
  std::string text = file_head("Collection") + "<Collection>\n";
  for (const auto& [time, file] : frames)
    text += "<DataSet timestep=\"" + exact_text(time) + "\" part=\"0\" file=\"" + escaped(file) + "\"/>\n";
  return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace drape
