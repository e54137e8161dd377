#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace drape {

/// A location in a file; line and column count from 1, 0 means unknown.
struct Location {
  std::string file;
  int line = 0;
  int column = 0;
  std::string key = {};  ///< path in its config, as `--set` takes it: "obstacles.0.radius"; empty if unknown
  std::string text() const;  ///< "file:line:column", without the parts that are unknown; the key if all are
};

/// A node of a config: a scalar, a list or a map, with its location. It hides the syntax of the file.
struct ConfigNode {
  enum class Kind { null, boolean, integer, number, text, list, map };

  ConfigNode() {}  // not defaulted: the type of `entries` is incomplete here
  explicit ConfigNode(Kind kind, std::string scalar = "", double number = 0)
      : kind(kind), scalar(std::move(scalar)), number(number) {}

  Kind kind = Kind::null;
  Location where;
  std::string scalar;             ///< scalar only: as written
  double number = 0;              ///< integer or number only; to the bit
  bool names_file = false;        ///< written from a parameter that is a path, or an item of one
  std::vector<ConfigNode> items;  ///< list only
  std::vector<std::pair<std::string, ConfigNode>> entries;  ///< map only, in order of writing
  std::vector<Location> key_locations;                      ///< map only, one per entry

  bool is_number() const { return kind == Kind::integer || kind == Kind::number; }
  bool is_scalar() const { return is_number() || kind == Kind::boolean || kind == Kind::text; }

  const ConfigNode* find(const std::string& key) const;  ///< map entry or null
  ConfigNode* find(const std::string& key) { return const_cast<ConfigNode*>(std::as_const(*this).find(key)); }
  /// The place of a map's entry; without the entry, the map's own.
  const Location& where_of(const std::string& key) const;
  /// Indices of the list's items that a word of a path names by their index from 0, their type or their name.
  std::vector<std::size_t> indices_of(const std::string& word) const;
  /// The index of the only item that it names; none if it names several.
  std::optional<std::size_t> index_of(const std::string& word) const;
  /// The map entry, or the only item of a list, that a word of a path names; null without one.
  const ConfigNode* child(const std::string& word) const;

  /// The plugin that the node chooses: a scalar's text, or that of a map's `type`; empty for others.
  const std::string& plugin_name() const;

  /// The node itself; for a scalar, the map that has it as the value of `key`, at the scalar's location.
  ConfigNode as_map(const std::string& key) const;
  /// Appends an entry, making a null node a map; returns the value in it.
  ConfigNode& add(const std::string& key, ConfigNode value);
  /// Removes a map's first entry of this key. Returns the key's location; nothing without the entry.
  std::optional<Location> remove(const std::string& key);

  void name_keys(const std::string& own = "");  ///< sets each location's key; own: this node's

  std::string one_line() const;  ///< as YAML; ambiguous texts are quoted
  std::string shown() const;     ///< for "must be …, not …": a scalar's text, or what else it is

  /// An integer that an int can hold, a number, true, false, or else a text.
  static ConfigNode plain(std::string text);
  static ConfigNode of(double value);  ///< a number, even a whole one; its text reads back the same
  static ConfigNode of(int value);
  static ConfigNode of(bool value);
  static ConfigNode of(const std::string& value);
  static ConfigNode of(const char* value) { return of(std::string(value)); }
};

/// The location of one byte of a scalar's text in the file that the text is from, whether it is plain, quoted
/// or a block of several lines; the scalar's own location where the file does not show it, as for an option.
Location location_in_text(const ConfigNode& scalar, std::size_t at);

/// A fault of a config: its location, and a message with a remedy.
struct ConfigError {
  Location where;
  std::string message;
  std::string shown = {};    ///< lines that show the place, as with a caret below it; may be empty
  std::string text() const;  ///< "file:line:column: message", then the lines
};

using ConfigErrors = std::vector<ConfigError>;

}  // namespace drape
