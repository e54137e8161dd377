// STL: triangles of three points each, as text or binary. Points that are equal become one vertex.
#include <algorithm>
#include <array>
#include <boost/algorithm/string/case_conv.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>

#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/numerics/mesh/mesh_builder.h"
#include "core/numerics/mesh_files/io_formats.h"
#include "core/numerics/mesh_files/text_reader.h"

namespace drape {
namespace {

constexpr std::size_t header_size = 84, triangle_size = 50;  // of binary files [bytes]

/// A mesh whose vertices are the points, each once, in the order of their first appearance.
class WeldedMesh {
 public:
  void add_corner(const std::array<double, 3>& point) {
    const std::array<double, 3> key{point[0] + 0.0, point[1] + 0.0, point[2] + 0.0};  // -0 is 0
    const auto [at, is_new] = vertices_.try_emplace(key, builder_.vertex_count());
    if (is_new) builder_.coordinates.insert(builder_.coordinates.end(), key.begin(), key.end());
    builder_.corners.push_back(at->second);
  }
  bool empty() const { return builder_.corners.empty(); }
  TriangleMesh mesh() const { return builder_.mesh(); }

 private:
  MeshBuilder builder_;
  std::map<std::array<double, 3>, int> vertices_;
};

/// The number of triangles that a binary file declares; -1 if the file is of another size.
std::int64_t binary_count(std::string_view bytes) {
  if (bytes.size() < header_size) return -1;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + header_size - sizeof count, sizeof count);
  return bytes.size() == header_size + triangle_size * count ? std::int64_t{count} : -1;
}

TriangleMesh read_binary(const std::filesystem::path& path, std::string_view bytes, std::int64_t count) {
  WeldedMesh mesh;
  for (std::int64_t t = 0; t < count; ++t) {
    float numbers[12];  // the normal, then three points
    std::memcpy(numbers, bytes.data() + header_size + triangle_size * t, sizeof numbers);
    for (int k = 1; k < 4; ++k) {
      const std::array<double, 3> point{numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]};
      for (const double x : point)
        if (!std::isfinite(x))
          refuse_path(path, "triangle " + std::to_string(t) +
                                " (counted from 0) has a coordinate that is not finite");
      mesh.add_corner(point);
    }
  }
  return mesh.mesh();
}

[[noreturn]] void refuse_size(const std::filesystem::path& path, std::string_view bytes) {
  refuse_path(path,
              "is no STL file: text begins with 'solid', and a binary file has 84 bytes and 50 for each of "
              "the triangles that it declares; this one has " +
                  std::to_string(bytes.size()) + " bytes");
}

TriangleMesh read_text(const std::filesystem::path& path, std::string_view bytes) {
  TextReader reader(path, bytes, '\0');
  WeldedMesh mesh;
  int corners = 0;  // of the current facet
  bool is_open = false;
  while (reader.next_line()) {
    const auto& words = reader.words();
    const std::string keyword = boost::to_lower_copy(std::string(words[0]));
    if (keyword == "vertex") {
      if (!is_open) reader.fail("a vertex stands outside a facet");
      if (words.size() != 4) reader.fail("a vertex needs three coordinates");
      if (++corners > 3) reader.fail("a facet has three vertices, not more");
      mesh.add_corner(
          {reader.coordinate(words[1]), reader.coordinate(words[2]), reader.coordinate(words[3])});
    } else if (keyword == "facet") {
      if (is_open) reader.fail("the facet before has no endfacet");
      is_open = true;
      corners = 0;
    } else if (keyword == "endfacet") {
      if (!is_open || corners != 3) reader.fail("a facet needs three vertices");
      is_open = false;
    } else if (keyword != "solid" && keyword != "endsolid" && keyword != "outer" && keyword != "endloop") {
      reader.fail("no line of an STL file begins with '" + excerpt(words[0]) + "'");
    }
  }
  if (is_open) reader.fail("the file ends within a facet");
  if (mesh.empty() && bytes.find('\0') != std::string_view::npos) refuse_size(path, bytes);
  if (mesh.empty()) reader.fail("the file ends without a facet");
  return mesh.mesh();
}

}  // namespace

TriangleMesh read_stl(const std::filesystem::path& path, std::string_view bytes) {
  if (const std::int64_t count = binary_count(bytes); count >= 0) return read_binary(path, bytes, count);
  const std::string_view text = utf8_text(path, bytes);
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  if (bytes.empty() || boost::to_lower_copy(std::string(text.substr(begin, 5))) == "solid")
    return read_text(path, bytes);
  refuse_size(path, bytes);
}

}  // namespace drape
