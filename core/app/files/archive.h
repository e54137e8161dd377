#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace drape {

static_assert(std::endian::native == std::endian::little, "numbers are written as memory holds them");

/// Whether a value can be copied as bytes.
template <class T>
inline constexpr bool is_plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Serialises values to bytes. For a struct, an overload of `fields(archive, value)` passes its members on,
/// the same for writing and reading.
class ArchiveWriter {
 public:
  std::string bytes;

  template <class... T>
  void operator()(const T&... values) {
    (put(values), ...);
  }

 private:
  void raw(const void* from, std::size_t size) { bytes.append(static_cast<const char*>(from), size); }
  void count(std::uint64_t n) { raw(&n, sizeof n); }

  template <class T>
  void put(const T& value) {
    if constexpr (is_plain<T>)
      raw(&value, sizeof value);
    else
      fields(*this, const_cast<T&>(value));  // which only reads it
  }
  void put(const std::string& text) {
    count(text.size());
    raw(text.data(), text.size());
  }
  template <class T>
  void put(const std::vector<T>& values) {
    count(values.size());
    if constexpr (is_plain<T>)
      raw(values.data(), sizeof(T) * values.size());
    else
      for (const T& value : values) put(value);
  }
  template <class T, std::size_t n>
  void put(const std::array<T, n>& values) {
    for (const T& value : values) put(value);
  }
  template <class A, class B>
  void put(const std::pair<A, B>& pair) {
    put(pair.first);
    put(pair.second);
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  template <class T>
  void put(const std::map<std::string, T>& map) {
    count(map.size());
    for (const auto& entry : map) put(entry);
  }
  template <int columns>
  void put(const Eigen::Matrix<double, Eigen::Dynamic, columns, Eigen::RowMajor>& matrix) {
    count(matrix.rows());
    raw(matrix.data(), sizeof(double) * matrix.size());
  }
};

/// Reads what ArchiveWriter wrote, from untrusted bytes: memory grows only as fast as bytes are read, and
/// every value is valid for its type. An enum T needs an overload of `bool is_value(T)`. Throws
/// std::runtime_error for truncated or invalid bytes.
class ArchiveReader {
 public:
  explicit ArchiveReader(std::string_view bytes) : bytes_(bytes) {}

  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }
  bool at_end() const { return bytes_.empty(); }

 private:
  void raw(void* to, std::size_t size) {
    require(size);
    if (size > 0) std::memcpy(to, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }
  void require(std::size_t size) const {
    if (size > bytes_.size()) throw std::runtime_error("it ends too early");
  }
  /// A number of items of at least `smallest` bytes each.
  std::size_t count(std::size_t smallest) {
    std::uint64_t n = 0;
    raw(&n, sizeof n);
    if (n > bytes_.size() / smallest) throw std::runtime_error("it ends too early");
    return n;
  }

  template <class T>
  void get(T& value) {
    if constexpr (std::is_enum_v<T>) {
      std::underlying_type_t<T> number{};
      get(number);
      if (!is_value(static_cast<T>(number)))
        throw std::runtime_error("it has " + std::to_string(number) + " for one of a list of words");
      value = static_cast<T>(number);
    } else if constexpr (is_plain<T>) {
      raw(&value, sizeof value);
    } else {
      fields(*this, value);
    }
  }
  /// A bool whose byte is neither 0 nor 1 is undefined behaviour.
  void get(bool& value) {
    std::uint8_t byte = 0;
    raw(&byte, sizeof byte);
    if (byte > 1) throw std::runtime_error("it has " + std::to_string(byte) + " for yes or no");
    value = byte == 1;
  }
  void get(std::string& text) {
    text.resize(count(1));
    raw(text.data(), text.size());
  }
  template <class T>
  void get(std::vector<T>& values) {
    static_assert(!std::is_same_v<T, bool> && !std::is_enum_v<T>, "would be read unchecked");
    if constexpr (std::is_arithmetic_v<T>) {
      values.resize(count(sizeof(T)));
      raw(values.data(), sizeof(T) * values.size());
    } else {
      values.clear();
      for (std::size_t n = count(1); n > 0; --n) get(values.emplace_back());
    }
  }
  template <class T, std::size_t n>
  void get(std::array<T, n>& values) {
    for (T& value : values) get(value);
  }
  template <class A, class B>
  void get(std::pair<A, B>& pair) {
    get(pair.first);
    get(pair.second);
  }
  template <class T>
  void get(std::optional<T>& value) {
    bool there = false;
    get(there);
    value.reset();
    if (there) get(value.emplace());
  }
  template <class T>
  void get(std::map<std::string, T>& map) {
    map.clear();
    for (std::size_t n = count(1); n > 0; --n) {
      std::pair<std::string, T> entry;
      get(entry);
      if (!map.empty() && entry.first <= map.rbegin()->first)
        throw std::runtime_error("it has keys out of order");
      map.insert(map.end(), std::move(entry));
    }
  }
  template <int columns>
  void get(Eigen::Matrix<double, Eigen::Dynamic, columns, Eigen::RowMajor>& matrix) {
    const std::size_t rows = count(sizeof(double) * columns);
    matrix.resize(static_cast<Eigen::Index>(rows), columns);
    raw(matrix.data(), sizeof(double) * matrix.size());
  }

  std::string_view bytes_;
};

}  // namespace drape
