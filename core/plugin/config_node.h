#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace drape {

/// A place in a file; line and column count from 1, 0 means unknown.
struct Location {
  std::string file;
  int line = 0;
  int column = 0;
  std::string text() const;  ///< "file:line:column", without the parts that are unknown
};

/// A piece of an experiment as it was written: a scalar's text, a list or a map, each with its place.
/// It keeps configs apart from the syntax they came in; types are decided where a node is read.
struct ConfigNode {
  enum class Kind { null, scalar, list, map };

  ConfigNode() {}  // not defaulted: `entries` is of a type that is complete only after this one

  Kind kind = Kind::null;
  Location where;
  std::string scalar;                                       ///< scalar only
  bool quoted = false;                                      ///< scalar only: text, whatever it looks like
  std::vector<ConfigNode> items;                            ///< list only
  std::vector<std::pair<std::string, ConfigNode>> entries;  ///< map only, in order of writing
  std::vector<Location> key_locations;                      ///< map only, one an entry

  const ConfigNode* find(const std::string& key) const;  ///< map entry or null

  void add(const std::string& key, ConfigNode value);  ///< appends an entry, making a null node a map

  std::string one_line() const;  ///< as YAML; text that could be taken for something else is quoted

  static ConfigNode of(double value);  ///< shortest text that reads back the same
  static ConfigNode of(int value);
  static ConfigNode of(bool value);
  static ConfigNode of(const std::string& value);
  static ConfigNode of(const char* value) { return of(std::string(value)); }
};

/// One thing wrong with a config: where, what, what to do.
struct ConfigError {
  Location where;
  std::string message;
  std::string text() const;  ///< "file:line:column: message"
};

using ConfigErrors = std::vector<ConfigError>;

}  // namespace drape
