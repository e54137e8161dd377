#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// A binary glTF file, read by the specification alone: nothing here is shared with the writer.
class Glb {
 public:
  /// Fails the test case for anything in header, chunks, views and accessors that does not fit.
  explicit Glb(const std::string& bytes) {
    REQUIRE(bytes.size() > 28);
    const std::uint32_t text = number(bytes, 12), size = number(bytes, 20 + text);
    CHECK(bytes.substr(0, 4) == "glTF");
    CHECK(number(bytes, 4) == 2);
    REQUIRE(number(bytes, 8) == bytes.size());
    CHECK(bytes.substr(16, 4) == "JSON");
    CHECK((bytes.substr(24 + text, 4) == std::string("BIN\0", 4)));
    CHECK((text % 4 == 0 && size % 4 == 0));
    REQUIRE(28 + text + size == bytes.size());
    json = nlohmann::json::parse(bytes.substr(20, text));
    binary_ = bytes.substr(28 + text);
    CHECK(json.at("asset").at("version") == "2.0");
    REQUIRE(json.at("buffers").size() == 1);
    CHECK(json["buffers"][0].at("byteLength") == size);
    CHECK_FALSE(json["buffers"][0].contains("uri"));
    for (std::size_t k = 0; k < json.at("accessors").size(); ++k) check_accessor(static_cast<int>(k));
  }

  /// The numbers of an accessor of floats, row by row.
  std::vector<float> floats(int accessor) const { return values<float>(accessor, 5126); }
  std::vector<std::uint32_t> indices(int accessor) const { return values<std::uint32_t>(accessor, 5125); }

  nlohmann::json json;

 private:
  static std::uint32_t number(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    REQUIRE(at + sizeof value <= bytes.size());
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  }

  static std::size_t columns(const nlohmann::json& accessor) {
    const std::string type = accessor.at("type");
    return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : 0;
  }

  template <class Number>
  std::vector<Number> values(int index, int component) const {
    const nlohmann::json& accessor = json.at("accessors").at(index);
    REQUIRE(accessor.at("componentType") == component);
    const nlohmann::json& view = json.at("bufferViews").at(accessor.at("bufferView").get<int>());
    const std::size_t offset = view.at("byteOffset"), length = view.at("byteLength");
    std::vector<Number> all(accessor.at("count").get<std::size_t>() * columns(accessor));
    CHECK(view.at("buffer") == 0);
    CHECK(offset % sizeof(Number) == 0);
    REQUIRE(length == all.size() * sizeof(Number));
    REQUIRE(offset + length <= binary_.size());
    std::memcpy(all.data(), binary_.data() + offset, length);
    return all;
  }

  void check_accessor(int index) const {
    const nlohmann::json& accessor = json["accessors"][index];
    INFO("accessor " << index << ": " << accessor);
    REQUIRE(columns(accessor) > 0);
    REQUIRE(accessor.at("count") > 0);
    if (accessor.at("componentType") == 5125) {
      indices(index);
      return;
    }
    const std::vector<float> all = floats(index);
    if (!accessor.contains("min")) return;
    const std::size_t n = columns(accessor);
    for (std::size_t c = 0; c < n; ++c) {
      std::vector<float> column;
      for (std::size_t k = c; k < all.size(); k += n) column.push_back(all[k]);
      CHECK(accessor["min"].at(c).get<float>() == std::ranges::min(column));
      CHECK(accessor.at("max").at(c).get<float>() == std::ranges::max(column));
    }
  }

  std::string binary_;
};
