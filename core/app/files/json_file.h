#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace drape {

struct ConfigNode;

/// JSON whose objects keep the order in which their keys were written.
using Json = nlohmann::ordered_json;

/// Reads values of a JSON file that a run or a sweep wrote and someone may have changed. A value of the wrong
/// type throws std::runtime_error with file, key and remedy.
class JsonFile {
 public:
  JsonFile(std::filesystem::path path, std::string remedy)
      : path_(std::move(path)), remedy_(std::move(remedy)) {}

  /// T is bool, int (not negative), std::uint32_t, double (finite) or std::string. Empty if the key is absent
  /// or null.
  template <class T>
  std::optional<T> find(const Json& object, const std::string& key) const;
  /// The value of a required key; refuses the file without one.
  template <class T>
  T at(const Json& object, const std::string& key) const {
    if (const std::optional<T> value = find<T>(object, key)) return *value;
    refuse("\"" + key + "\" is missing");
  }
  /// The place below the file's folder that a required text names; refuses one that leads out of the folder.
  std::filesystem::path inside(const Json& object, const std::string& key) const;
  /// The same, to be written to: refuses one that leads through a link.
  std::filesystem::path place(const Json& object, const std::string& key) const;
  [[noreturn]] void refuse(const std::string& fault) const;

 private:
  std::filesystem::path path_;
  std::string remedy_;
};

/// Throws if a part of the way below a folder is a symbolic link.
void refuse_links(const std::filesystem::path& folder, const std::filesystem::path& way);

/// A member of an object; null if the key is absent or the node is not an object.
const Json& member_of(const Json& object, std::string_view key);
/// A member's text; empty if it is not a text.
std::string text_member(const Json& object, const std::string& key);
/// A member's finite number; nothing if it is not one. "energy_parts.hinge" is the member hinge of
/// energy_parts.
std::optional<double> number_member(const Json& object, const std::string& key);

/// The value that a JSON text describes; discarded (nlohmann's is_discarded(), without a type) if it is not
/// JSON.
Json parse_json(const std::string& text);
/// The JSON's text, on one line without `indent`. Bytes that are not UTF-8, as in a file's name, are
/// replaced; a number that is not finite, which JSON does not have, becomes null.
std::string json_text(const Json& json, int indent = -1);
/// The JSON's text in ASCII, other characters escaped, on one line without an indent: for scripts of a page,
/// whatever its encoding, and for terminals.
std::string ascii_json_text(const Json& json, int indent = -1);

/// The node as JSON; unquoted scalars become numbers or booleans if they spell one.
Json json_value(const ConfigNode& node);

/// Why files that results.json names cannot begin with this name, as in "has 300 bytes, and may have 200"; ""
/// if they can. Checked before a run rather than left to the file system in its middle.
std::string fault_of_file_name(const std::string& name);

}  // namespace drape
