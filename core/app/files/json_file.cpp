#include "core/app/files/json_file.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/kernel/files/message_text.h"

namespace drape {

using Json = JsonFile::Json;

const Json& member_of(const Json& object, const std::string& key) {
  static const Json absent;
  if (!object.is_object()) return absent;
  const auto found = object.find(key);
  return found != object.end() ? *found : absent;
}

std::string text_member(const Json& object, const std::string& key) {
  const Json& text = member_of(object, key);
  return text.is_string() ? text.get<std::string>() : std::string();
}

// Parsing and writing are large templates: they are compiled here alone.
Json parse_json(const std::string& text) { return Json::parse(text, nullptr, false); }

std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string ascii_json_text(const Json& json) {
  return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

void JsonFile::refuse(const std::string& fault) const {
  throw std::runtime_error(path_.string() + ": " + fault + "; " + remedy_);
}

void JsonFile::refuse(const std::string& key, const std::string& kind, const Json& value) const {
  const std::string found = json_text(value);
  refuse("\"" + key + "\" must be " + kind + ", not " + excerpt(found));
}

template <>
std::optional<bool> JsonFile::find(const Json& object, const std::string& key) const {
  const Json& value = member_of(object, key);
  if (value.is_null()) return {};
  if (!value.is_boolean()) refuse(key, "true or false", value);
  return value.get<bool>();
}

template <>
std::optional<double> JsonFile::find(const Json& object, const std::string& key) const {
  const Json& value = member_of(object, key);
  if (value.is_null()) return {};
  if (!value.is_number() || !std::isfinite(value.get<double>())) refuse(key, "a number", value);
  return value.get<double>();
}

template <>
std::optional<int> JsonFile::find(const Json& object, const std::string& key) const {
  const Json& value = member_of(object, key);
  if (value.is_null()) return {};
  const std::optional<int> whole = value.is_number() ? whole_number(value.get<double>()) : std::nullopt;
  if (!whole) refuse(key, "a whole number", value);
  return whole;
}

template <>
std::optional<std::string> JsonFile::find(const Json& object, const std::string& key) const {
  const Json& value = member_of(object, key);
  if (value.is_null()) return {};
  if (!value.is_string()) refuse(key, "a text", value);
  return value.get<std::string>();
}

std::optional<int> whole_number(double value) {
  if (!(value >= 0 && value <= std::numeric_limits<int>::max()) || value != std::floor(value)) return {};
  return static_cast<int>(value);
}

}  // namespace drape
