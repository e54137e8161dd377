#include "core/app/files/json_file.h"

#include <cmath>
#include <limits>
#include <type_traits>

#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/plugin/config_node.h"

namespace drape {

namespace {

constexpr int most_levels = 100;

bool is_nested_deeply(const std::string& text) {
  int depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') in_text = !in_text;
    if (in_text && c == '\\') ++i;
    if (in_text) continue;
    if ((c == '[' || c == '{') && ++depth > most_levels) return true;
    if (c == ']' || c == '}') --depth;
  }
  return false;
}

}  // namespace

const Json& member_of(const Json& object, std::string_view key) {
  static const Json absent;
  if (!object.is_object()) return absent;
  const auto found = object.find(key);
  return found != object.end() ? *found : absent;
}

std::string text_member(const Json& object, const std::string& key) {
  const Json& text = member_of(object, key);
  return text.is_string() ? text.get<std::string>() : std::string();
}

std::optional<double> number_member(const Json& object, const std::string& key) {
  const Json& own = member_of(object, key);
  if (own.is_number() && std::isfinite(own.get<double>())) return own.get<double>();
  // The key may lead into an object at each of its dots: a member's own name may have some.
  for (std::size_t dot = key.find('.'); dot != key.npos; dot = key.find('.', dot + 1))
    if (const auto number = number_member(member_of(object, key.substr(0, dot)), key.substr(dot + 1)))
      return number;
  return {};
}

// Parsing and writing are large templates: they are compiled here alone.
Json parse_json(const std::string& text) {
  if (!is_nested_deeply(text)) return Json::parse(text, nullptr, false);
  // What is deeper is left out, since values are copied and written by recursion. With a callback the time of
  // parsing grows with the square of a list's length.
  return Json::parse(
      text, [](int depth, Json::parse_event_t, Json&) { return depth < most_levels; }, false);
}

std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string ascii_json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', true, Json::error_handler_t::replace);
}

std::string fault_of_file_name(const std::string& name) {
  constexpr std::size_t most = 200;  // bytes: most file systems allow 255; a run appends endings
  if (first_unprintable(name) != name.npos) return "is no UTF-8, which results.json needs";
  if (name.size() <= most) return "";
  return "has " + std::to_string(name.size()) + " bytes, and may have " + std::to_string(most);
}

void JsonFile::refuse(const std::string& fault) const { refuse_path(path_, fault + "; " + remedy_); }

void refuse_links(const std::filesystem::path& folder, const std::filesystem::path& way) {
  std::filesystem::path place = folder;
  for (const auto& part : way) {
    place /= part;
    if (is_symlink(place))
      refuse_path(place,
                  "is a link, and drape writes into folders of its own; remove it, or make it a folder");
  }
}

std::filesystem::path JsonFile::inside(const Json& object, const std::string& key) const {
  const std::filesystem::path way = std::filesystem::path(at<std::string>(object, key)).lexically_normal();
  if (way.empty() || way.is_absolute() || *way.begin() == "..")
    refuse("\"" + excerpt(way.string()) + "\" leads out of the folder");
  return path_.parent_path() / way;
}

std::filesystem::path JsonFile::place(const Json& object, const std::string& key) const {
  const std::filesystem::path folder = path_.parent_path();
  std::filesystem::path place = inside(object, key);
  refuse_links(folder, place.lexically_relative(folder));
  return place;
}

template <class T>
std::optional<T> JsonFile::find(const Json& object, const std::string& key) const {
  const Json& value = member_of(object, key);
  if (value.is_null()) return {};
  const auto require = [&](bool fits, const char* kind) {
    if (!fits) refuse("\"" + key + "\" must be " + kind + ", not " + excerpt(json_text(value)));
  };
  if constexpr (std::is_same_v<T, bool>) {
    require(value.is_boolean(), "true or false");
  } else if constexpr (std::is_same_v<T, std::string>) {
    require(value.is_string(), "a text");
  } else {
    constexpr bool whole = std::is_integral_v<T>;
    const double number = value.is_number() ? value.get<double>() : std::nan("");
    const bool fits =
        whole ? number >= 0 && number <= std::numeric_limits<T>::max() && number == std::floor(number)
              : std::isfinite(number);
    require(fits, whole ? "a whole number" : "a number");
  }
  return value.get<T>();
}

template std::optional<bool> JsonFile::find(const Json& object, const std::string& key) const;
template std::optional<int> JsonFile::find(const Json& object, const std::string& key) const;
template std::optional<std::uint32_t> JsonFile::find(const Json& object, const std::string& key) const;
template std::optional<double> JsonFile::find(const Json& object, const std::string& key) const;
template std::optional<std::string> JsonFile::find(const Json& object, const std::string& key) const;

Json json_value(const ConfigNode& node) {
  Json json;
  switch (node.kind) {
    case ConfigNode::Kind::null:
      break;
    case ConfigNode::Kind::list:
      json = Json::array();
      for (const ConfigNode& item : node.items) json.push_back(json_value(item));
      break;
    case ConfigNode::Kind::map:
      json = Json::object();
      for (const auto& [key, value] : node.entries) json[key] = json_value(value);
      break;
    case ConfigNode::Kind::boolean:
      return node.scalar == "true";
    case ConfigNode::Kind::integer:
    case ConfigNode::Kind::number:
      if (const auto integer = parse_integer(node.scalar)) return *integer;
      return node.number;
    case ConfigNode::Kind::text:
      return node.scalar;
  }
  return json;
}

}  // namespace drape
