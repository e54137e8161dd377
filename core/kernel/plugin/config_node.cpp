#include "core/kernel/plugin/config_node.h"

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <cctype>
#include <cstdio>
#include <set>

#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {
namespace {

/// Whether every YAML reader reads the unquoted text as a text.
bool plainly_text(const std::string& text) {
  static const std::set<std::string> taken = {"true", "false", "null", "yes", "no", "on", "off"};
  const auto harmless = [](unsigned char c) {
    return std::isalnum(c) || c >= 0x80 || c == '_' || c == '-' || c == '.' || c == '/' || c == ' ';
  };
  const auto begins = [](unsigned char c) { return std::isalpha(c) || c == '_' || c == '/'; };
  return !text.empty() && begins(static_cast<unsigned char>(text[0])) && text.back() != ' ' &&
         std::all_of(text.begin(), text.end(), harmless) && !taken.count(boost::to_lower_copy(text));
}

std::string in_quotes(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (c == '\n') {
      quoted += "\\n";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      char code[8];
      std::snprintf(code, sizeof code, "\\x%02x", static_cast<unsigned>(c));
      quoted += code;
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// The byte of the file at which a line and column begin; npos without them.
std::size_t offset_of(const std::string& file, const Location& where) {
  std::size_t line = 0;
  for (int i = 1; i < where.line; ++i) {
    line = file.find('\n', line);
    if (line == std::string::npos) return line;
    ++line;
  }
  return std::min(line + static_cast<std::size_t>(where.column - 1), file.size());
}

/// The byte of the file that is byte `at` of the text, which begins behind `begin`. Line breaks and
/// indentation may differ between the two. npos if they do not agree.
std::size_t matching(const std::string& file, std::size_t begin, const std::string& text, std::size_t at) {
  std::size_t i = begin;
  if (i < file.size() && (file[i] == '"' || file[i] == '\'')) ++i;
  if (i < file.size() && (file[i] == '|' || file[i] == '>')) i = std::min(file.find('\n', i), file.size());
  for (std::size_t j = 0;; ++j, ++i) {
    while (j < text.size() && is_space(text[j]) && j < at) ++j;
    while (i < file.size() && is_space(file[i]) && j < text.size()) ++i;
    if (j == at) return i;
    if (j == text.size() || i == file.size() || text[j] != file[i]) return std::string::npos;
  }
}

}  // namespace

std::string Location::text() const {
  std::string text = file;
  for (int number : {line, column}) {
    if (number <= 0) break;
    text += (text.empty() ? "" : ":") + std::to_string(number);
  }
  return text.empty() ? key : text;
}

std::string ConfigError::text() const {
  const std::string place = where.text();
  const std::string sentence = printable(place.empty() ? message : place + ": " + message);
  return shown.empty() ? sentence : sentence + "\n" + printable_lines(shown);
}

std::vector<std::size_t> ConfigNode::indices_of(const std::string& word) const {
  if (const auto index = parse_integer(word)) {
    if (*index < 0 || *index >= static_cast<int>(items.size())) return {};
    return {static_cast<std::size_t>(*index)};
  }
  std::vector<std::size_t> named;
  for (std::size_t i = 0; i < items.size(); ++i) {
    bool is_named = items[i].is_scalar() && items[i].scalar == word;
    for (const char* key : {"type", "name"})
      if (const ConfigNode* own = items[i].find(key); own && own->scalar == word) is_named = true;
    if (is_named) named.push_back(i);
  }
  return named;
}

std::optional<std::size_t> ConfigNode::index_of(const std::string& word) const {
  const std::vector<std::size_t> named = indices_of(word);
  return named.size() == 1 ? std::optional(named[0]) : std::nullopt;
}

const ConfigNode* ConfigNode::find(const std::string& key) const {
  for (const auto& [name, value] : entries)
    if (name == key) return &value;
  return nullptr;
}

const ConfigNode* ConfigNode::child(const std::string& word) const {
  if (kind != Kind::list) return find(word);
  const std::optional<std::size_t> index = index_of(word);
  return index ? &items[*index] : nullptr;
}

const Location& ConfigNode::where_of(const std::string& key) const {
  const ConfigNode* entry = find(key);
  return entry ? entry->where : where;
}

const std::string& ConfigNode::plugin_name() const {
  const ConfigNode* type = find("type");
  return (type ? *type : *this).scalar;
}

ConfigNode ConfigNode::as_map(const std::string& key) const {
  if (!is_scalar()) return *this;
  ConfigNode map;
  map.where = where;
  map.add(key, *this);
  return map;
}

ConfigNode& ConfigNode::add(const std::string& key, ConfigNode value) {
  kind = Kind::map;
  key_locations.push_back(value.where);
  return entries.emplace_back(key, std::move(value)).second;
}

std::optional<Location> ConfigNode::remove(const std::string& key) {
  const auto entry = std::ranges::find(entries, key, &std::pair<std::string, ConfigNode>::first);
  if (entry == entries.end()) return std::nullopt;
  const auto place = key_locations.begin() + (entry - entries.begin());
  Location where = *place;
  key_locations.erase(place);
  entries.erase(entry);
  return where;
}

void ConfigNode::name_keys(const std::string& own) {
  const std::string before = own.empty() ? "" : own + ".";
  where.key = own;
  for (std::size_t i = 0; i < items.size(); ++i) items[i].name_keys(before + std::to_string(i));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    auto& [key, value] = entries[i];
    value.name_keys(before + key);
    key_locations[i].key = before + key;
  }
}

std::string ConfigNode::one_line() const {
  if (kind == Kind::null) return "null";
  if (is_scalar()) return kind != Kind::text || plainly_text(scalar) ? scalar : in_quotes(scalar);
  std::string text;
  for (const ConfigNode& item : items) text += (text.empty() ? "" : ", ") + item.one_line();
  for (const auto& [key, value] : entries)
    text += (text.empty() ? "" : ", ") + of(key).one_line() + ": " + value.one_line();
  return kind == Kind::list ? "[" + text + "]" : "{" + text + "}";
}

std::string ConfigNode::shown() const {
  if (kind == Kind::null) return "empty";
  if (!is_scalar()) return kind == Kind::list ? "a list" : "a map";
  const std::string text = excerpt(scalar);
  const bool looks_otherwise = kind == Kind::text && plain(scalar).kind != Kind::text;
  return is_number() ? text : (looks_otherwise ? "the text \"" : "\"") + text + "\"";
}

ConfigNode ConfigNode::plain(std::string text) {
  const std::optional<double> number = parse_number(text);
  const bool boolean = text == "true" || text == "false";
  const Kind kind = parse_integer(text) ? Kind::integer
                    : number            ? Kind::number
                    : boolean           ? Kind::boolean
                                        : Kind::text;
  return ConfigNode(kind, std::move(text), number.value_or(0));
}

ConfigNode ConfigNode::of(double value) {
  std::string digits = exact_text(value);
  // YAML 1.1, as in Python, reads "1e-05" as a text and "1.0e-05" as a number.
  const size_t exponent = digits.find('e');
  if (exponent != std::string::npos && digits.find('.') == std::string::npos) digits.insert(exponent, ".0");
  return ConfigNode(Kind::number, std::move(digits), value);
}

ConfigNode ConfigNode::of(int value) { return plain(std::to_string(value)); }
ConfigNode ConfigNode::of(bool value) { return plain(value ? "true" : "false"); }
ConfigNode ConfigNode::of(const std::string& value) { return ConfigNode(Kind::text, value); }

Location location_in_text(const ConfigNode& scalar, std::size_t at) {
  Location where = scalar.where;
  if (!scalar.is_scalar() || where.line <= 0 || where.column <= 0) return where;
  std::string file;
  try {
    file = read_file(where.file);
  } catch (const std::exception&) {
    return where;
  }
  const std::size_t begin = offset_of(file, where);
  if (begin == std::string::npos) return where;
  const std::size_t found = matching(file, begin, scalar.scalar, std::min(at, scalar.scalar.size()));
  if (found == std::string::npos) return where;
  const auto end = file.begin() + static_cast<std::ptrdiff_t>(found);
  where.line = static_cast<int>(std::count(file.begin(), end, '\n')) + 1;
  const std::size_t line = found == 0 ? 0 : file.rfind('\n', found - 1) + 1;  // npos + 1 is 0
  where.column = static_cast<int>(found - line) + 1;
  return where;
}

}  // namespace drape
