#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
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

/// Takes values as bytes, as memory holds them. `pass` below goes through a value in the same way to write
/// and to read it.
struct ArchiveWriter {
  static constexpr bool reads = false;
  std::string bytes;

  void raw(void* from, std::size_t size) { bytes.append(static_cast<const char*>(from), size); }
  std::size_t count(std::uint64_t n, std::size_t) {
    raw(&n, sizeof n);
    return n;
  }
};

/// Gives what ArchiveWriter took, from untrusted bytes: memory grows only as fast as bytes are read, and
/// every value is valid for its type. Throws std::runtime_error for truncated or invalid bytes.
struct ArchiveReader {
  static constexpr bool reads = true;
  std::string_view bytes;

  void raw(void* to, std::size_t size) {
    if (size > bytes.size()) throw std::runtime_error("it ends too early");
    if (size > 0) std::memcpy(to, bytes.data(), size);
    bytes.remove_prefix(size);
  }
  /// A number of items of at least `smallest` bytes each.
  std::size_t count(std::uint64_t n, std::size_t smallest) {
    raw(&n, sizeof n);
    if (n > bytes.size() / smallest) throw std::runtime_error("it ends too early");
    return n;
  }
};

/// Converts to anything, to count the members of an aggregate.
struct AnyMember {
  std::size_t place;
  template <class T>
  operator T&() const&;
  template <class T>
  operator T&() const&&;
};

template <class T, std::size_t... places>
constexpr bool has_members(std::index_sequence<places...>) {
  return requires { T{AnyMember{places}...}; };
}

/// The number of an aggregate's members.
template <class T, std::size_t most = 19>
constexpr std::size_t member_count() {
  static_assert(most > 0, "an aggregate of 1 to 19 members");
  if constexpr (has_members<T>(std::make_index_sequence<most>()))
    return most;
  else
    return member_count<T, most - 1>();
}

/// Calls body(members...) with references to the members of an aggregate, in their order.
template <class T, class Body>
void with_members(T& value, const Body& body) {
  constexpr std::size_t n = member_count<T>();
  // clang-format off
  if constexpr (n == 1) { auto& [a] = value; body(a); }
  if constexpr (n == 2) { auto& [a, b] = value; body(a, b); }
  if constexpr (n == 3) { auto& [a, b, c] = value; body(a, b, c); }
  if constexpr (n == 4) { auto& [a, b, c, d] = value; body(a, b, c, d); }
  if constexpr (n == 5) { auto& [a, b, c, d, e] = value; body(a, b, c, d, e); }
  if constexpr (n == 6) { auto& [a, b, c, d, e, f] = value; body(a, b, c, d, e, f); }
  if constexpr (n == 7) { auto& [a, b, c, d, e, f, g] = value; body(a, b, c, d, e, f, g); }
  if constexpr (n == 8) { auto& [a, b, c, d, e, f, g, h] = value; body(a, b, c, d, e, f, g, h); }
  if constexpr (n == 9) { auto& [a, b, c, d, e, f, g, h, i] = value; body(a, b, c, d, e, f, g, h, i); }
  if constexpr (n == 10) { auto& [a, b, c, d, e, f, g, h, i, j] = value; body(a, b, c, d, e, f, g, h, i, j); }
  if constexpr (n == 15) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p] = value;
    body(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p);
  }
  if constexpr (n == 19) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t] = value;
    body(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r, s, t);
  }
  // clang-format on
  static_assert(n <= 10 || n == 15 || n == 19, "add a line for so many members");
}

/// A number, an enumeration with an overload of `bool is_value(T)`, or a struct by its members.
template <class Archive, class T>
void pass(Archive& archive, T& value) {
  if constexpr (std::is_same_v<T, bool>) {  // a byte that is neither 0 nor 1 is undefined behaviour
    std::uint8_t byte = value;
    archive.raw(&byte, sizeof byte);
    if (byte > 1) throw std::runtime_error("it has " + std::to_string(byte) + " for yes or no");
    value = byte == 1;
  } else if constexpr (std::is_enum_v<T>) {
    auto number = static_cast<std::underlying_type_t<T>>(value);
    archive.raw(&number, sizeof number);
    if (!is_value(static_cast<T>(number)))
      throw std::runtime_error("it has " + std::to_string(number) + " for one of a list of words");
    value = static_cast<T>(number);
  } else if constexpr (std::is_arithmetic_v<T>) {
    archive.raw(&value, sizeof value);
  } else {
    with_members(value, [&](auto&... members) { (pass(archive, members), ...); });
  }
}

template <class Archive>
void pass(Archive& archive, std::string& text) {
  text.resize(archive.count(text.size(), 1));
  archive.raw(text.data(), text.size());
}

template <class Archive, class T>
void pass(Archive& archive, std::vector<T>& values) {
  static_assert(!std::is_same_v<T, bool> && !std::is_enum_v<T>, "would be read unchecked");
  if constexpr (std::is_arithmetic_v<T>) {
    values.resize(archive.count(values.size(), sizeof(T)));
    archive.raw(values.data(), sizeof(T) * values.size());
  } else {
    const std::size_t n = archive.count(values.size(), 1);
    if (Archive::reads) values.clear();
    for (std::size_t k = 0; k < n; ++k) pass(archive, Archive::reads ? values.emplace_back() : values[k]);
  }
}

template <class Archive, class T, std::size_t n>
void pass(Archive& archive, std::array<T, n>& values) {
  for (T& value : values) pass(archive, value);
}

template <class Archive, class A, class B>
void pass(Archive& archive, std::pair<A, B>& pair) {
  pass(archive, pair.first);
  pass(archive, pair.second);
}

template <class Archive, class T>
void pass(Archive& archive, std::optional<T>& value) {
  bool there = value.has_value();
  pass(archive, there);
  if (there) pass(archive, Archive::reads ? value.emplace() : *value);
  if (!there) value.reset();
}

template <class Archive, class T>
void pass(Archive& archive, std::map<std::string, T>& map) {
  std::vector<std::pair<std::string, T>> entries(map.begin(), map.end());
  pass(archive, entries);
  for (std::size_t k = 1; k < entries.size(); ++k)
    if (entries[k].first <= entries[k - 1].first) throw std::runtime_error("it has keys out of order");
  map = {entries.begin(), entries.end()};
}

/// n×columns, or a vector of fixed size.
template <class Archive, int rows, int columns, int options>
void pass(Archive& archive, Eigen::Matrix<double, rows, columns, options>& matrix) {
  if constexpr (rows == Eigen::Dynamic)
    matrix.resize(static_cast<Eigen::Index>(archive.count(matrix.rows(), sizeof(double) * columns)), columns);
  archive.raw(matrix.data(), sizeof(double) * matrix.size());
}

}  // namespace drape
