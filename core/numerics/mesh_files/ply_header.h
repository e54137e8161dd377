#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/numerics/mesh_files/text_reader.h"

namespace drape {

/// Types of PLY numbers: int8 … float64.
enum class PlyType { i8, u8, i16, u16, i32, u32, f32, f64 };
inline constexpr std::array<std::size_t, 8> ply_type_size{1, 1, 2, 2, 4, 4, 4, 8};

struct PlyProperty {
  std::string name;
  PlyType type;
  std::optional<PlyType> count_type;  ///< lists only
};

/// A kind of element in the file, the number of them and their properties.
struct PlyElement {
  std::string name;
  int count;
  std::vector<PlyProperty> properties;
};

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyHeader {
  PlyFormat format;
  std::vector<PlyElement> elements;
  std::vector<std::string> pieces;  ///< of lines "comment piece NAME", which the faces' `piece` counts
  std::optional<double> uv_length;  ///< of "comment uv_length METRES", the length of a unit of uv
};

/// Reads from "ply" to "end_header"; the reader is then behind that line.
PlyHeader read_ply_header(TextReader& reader);

}  // namespace drape
