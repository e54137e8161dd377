#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
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

/// The number that these bytes begin with.
template <class Number>
double decode_ply(std::array<char, 8> bytes) {
  Number number;
  std::memcpy(&number, bytes.data(), sizeof number);
  return static_cast<double>(number);
}

/// The decoder of each PlyType.
inline constexpr std::array<double (*)(std::array<char, 8>), 8> ply_decoders{
    decode_ply<std::int8_t>,  decode_ply<std::uint8_t>,  decode_ply<std::int16_t>, decode_ply<std::uint16_t>,
    decode_ply<std::int32_t>, decode_ply<std::uint32_t>, decode_ply<float>,        decode_ply<double>};

/// The numbers behind the header, whatever their encoding.
class PlyBody {
 public:
  PlyBody(TextReader& reader, std::string_view bytes, PlyFormat format, std::filesystem::path path)
      : reader_(reader), bytes_(bytes.substr(reader.position())), format_(format), path_(std::move(path)) {}

  void enter(const PlyElement& element, int number) {
    end_line();
    element_ = &element, number_ = number;
  }

  /// Nothing but white space may follow the last element.
  void finish() {
    end_line();
    const bool more = format_ == PlyFormat::ascii ? reader_.next_line()
                                                  : bytes_.find_first_not_of(" \t\r\n") != bytes_.npos;
    if (more) refuse("the file has data after the elements that its header declares");
  }

  double next(PlyType type) {
    if (format_ == PlyFormat::ascii) {
      const std::string_view word = reader_.next_word(place());
      return type == PlyType::f32 || type == PlyType::f64 ? reader_.number(word)
                                                          : static_cast<double>(reader_.integer(word));
    }
    const std::size_t size = ply_type_size[static_cast<int>(type)];
    if (bytes_.size() < size) fail("the file ends");
    std::array<char, 8> bytes;
    std::copy_n(bytes_.data(), size, bytes.data());
    if (format_ == PlyFormat::big_endian) std::reverse(bytes.begin(), bytes.begin() + size);
    bytes_.remove_prefix(size);
    return ply_decoders[static_cast<int>(type)](bytes);
  }

  /// The message begins with the element.
  [[noreturn]] void fail(const std::string& message) const { refuse(place() + ": " + message); }

 private:
  [[noreturn]] void refuse(const std::string& message) const {
    if (format_ == PlyFormat::ascii) reader_.fail(message);
    refuse_path(path_, message + reader_.note());
  }

  /// An element of a text may take several lines, but shares none.
  void end_line() const {
    if (format_ == PlyFormat::ascii && reader_.has_words_left())
      fail("its line has more values than the header declares");
  }

  std::string place() const { return excerpt(element_->name) + " " + std::to_string(number_); }

  TextReader& reader_;
  std::string_view bytes_;
  PlyFormat format_;
  std::filesystem::path path_;
  const PlyElement* element_ = nullptr;
  int number_ = 0;
};

}  // namespace drape
