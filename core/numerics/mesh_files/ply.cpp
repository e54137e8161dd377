#include "core/numerics/mesh_files/ply.h"

#include <set>

namespace drape {
namespace {

PlyType read_type(const TextReader& reader, std::string_view word) {
  constexpr std::array<std::string_view, 8> names{"char", "uchar", "short", "ushort",
                                                  "int",  "uint",  "float", "double"};
  constexpr std::array<std::string_view, 8> sized{"int8",  "uint8",  "int16",   "uint16",
                                                  "int32", "uint32", "float32", "float64"};
  for (std::size_t i = 0; i < names.size(); ++i)
    if (word == names[i] || word == sized[i]) return static_cast<PlyType>(i);
  reader.fail("unknown property type '" + excerpt(word) + "'");
}

PlyProperty read_property(const TextReader& reader) {
  const auto& words = reader.words();
  if (words.size() == 3) return {std::string(words[2]), read_type(reader, words[1]), std::nullopt};
  if (words.size() != 5 || words[1] != "list")
    reader.fail("expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
  const PlyType count_type = read_type(reader, words[2]);
  if (count_type == PlyType::f32 || count_type == PlyType::f64)
    reader.fail("the length of a list must be an integer");
  return {std::string(words[4]), read_type(reader, words[3]), count_type};
}

PlyFormat read_format(const TextReader& reader) {
  const auto& words = reader.words();
  if (words.size() == 3 && words[2] == "1.0") {
    if (words[1] == "ascii") return PlyFormat::ascii;
    if (words[1] == "binary_little_endian") return PlyFormat::little_endian;
    if (words[1] == "binary_big_endian") return PlyFormat::big_endian;
  }
  reader.fail("expected 'format ascii|binary_little_endian|binary_big_endian 1.0'");
}

}  // namespace

PlyHeader read_ply_header(TextReader& reader) {
  if (!reader.next_line() || reader.words().size() != 1 || reader.words()[0] != "ply")
    reader.fail("a PLY file begins with a line 'ply'");
  std::optional<PlyFormat> format;
  std::vector<PlyElement> elements;
  std::set<std::string> names, properties;  // of the elements, and of the last one's properties
  std::vector<std::string> pieces;
  std::optional<double> uv_length;
  while (reader.next_line()) {
    const auto& words = reader.words();
    if (words[0] == "end_header") {
      if (!format) reader.fail("the header has no format line");
      reader.finish_line();
      return {*format, std::move(elements), std::move(pieces), uv_length};
    }
    if (words[0] == "comment" && words.size() >= 3 && words[1] == "piece")
      pieces.emplace_back(words[2].begin(), words.back().end());  // a name may have blanks
    if (words[0] == "comment" && words.size() == 3 && words[1] == "uv_length")
      uv_length = reader.number(words[2]);
    if (words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "format") {
      if (format) reader.fail("the format is declared twice");
      format = read_format(reader);
    } else if (words[0] == "element") {
      if (words.size() != 3) reader.fail("expected 'element NAME COUNT'");
      const std::string name(words[1]), shown = "'" + excerpt(name) + "'";
      if (!names.insert(name).second) reader.fail("element " + shown + " is declared twice");
      properties.clear();
      elements.push_back({name, reader.count(words[2], "elements " + shown), {}});
    } else if (words[0] == "property") {
      if (elements.empty()) reader.fail("a property stands before the first element");
      PlyProperty property = read_property(reader);
      if (!properties.insert(property.name).second)
        reader.fail("property '" + excerpt(property.name) + "' is declared twice");
      elements.back().properties.push_back(std::move(property));
    } else {
      reader.fail("unknown header line '" + excerpt(words[0]) + "'");
    }
  }
  reader.fail("the header has no end_header");
}

}  // namespace drape
