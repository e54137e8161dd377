#include "core/kernel/plugin/config_node.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <set>

#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {
namespace {

ConfigNode scalar_node(std::string text, bool quoted) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::scalar;
  node.scalar = std::move(text);
  node.quoted = quoted;
  return node;
}

/// Whether every YAML reader reads the unquoted text as a text.
bool plainly_text(const std::string& text) {
  static const std::set<std::string> taken = {"true", "false", "null", "yes", "no", "on", "off"};
  std::string lower = text;
  for (char& c : lower) c = char(std::tolower(static_cast<unsigned char>(c)));
  const auto harmless = [](unsigned char c) {
    return std::isalnum(c) || c >= 0x80 || c == '_' || c == '-' || c == '.' || c == '/' || c == ' ';
  };
  const auto begins = [](unsigned char c) { return std::isalpha(c) || c == '_' || c == '/'; };
  return !text.empty() && begins(static_cast<unsigned char>(text[0])) && text.back() != ' ' &&
         std::all_of(text.begin(), text.end(), harmless) && !taken.count(lower);
}

/// Whether the text looks like a number or a word and has no YAML syntax in it.
bool plainly_scalar(const std::string& text) {
  const auto is_word = [](unsigned char c) { return std::isalnum(c); };
  const auto harmless = [&](unsigned char c) { return is_word(c) || c == '.' || c == '+' || c == '-'; };
  return std::any_of(text.begin(), text.end(), is_word) && std::all_of(text.begin(), text.end(), harmless);
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
    bool is_named = items[i].kind == Kind::scalar && items[i].scalar == word;
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

const Location& ConfigNode::where_of(const std::string& key) const {
  const ConfigNode* entry = find(key);
  return entry ? entry->where : where;
}

const std::string& ConfigNode::plugin_name() const {
  const ConfigNode* type = find("type");
  return (type ? *type : *this).scalar;
}

void ConfigNode::add(const std::string& key, ConfigNode value) {
  kind = Kind::map;
  key_locations.push_back(value.where);
  entries.emplace_back(key, std::move(value));
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
  if (kind == Kind::scalar)
    return plainly_text(scalar) || (!quoted && plainly_scalar(scalar)) ? scalar : in_quotes(scalar);
  std::string text;
  for (const ConfigNode& item : items) text += (text.empty() ? "" : ", ") + item.one_line();
  for (const auto& [key, value] : entries)
    text += (text.empty() ? "" : ", ") + of(key).one_line() + ": " + value.one_line();
  return kind == Kind::list ? "[" + text + "]" : "{" + text + "}";
}

std::string ConfigNode::shown() const {
  if (kind == Kind::null) return "empty";
  if (kind != Kind::scalar) return kind == Kind::list ? "a list" : "a map";
  const bool number = !quoted && parse_number(scalar);
  const std::string text = excerpt(scalar);
  return number ? text : (quoted ? "the text \"" : "\"") + text + "\"";
}

ConfigNode ConfigNode::of(double value) {
  std::string digits = exact_text(value);
  // YAML 1.1, as in Python, reads "1e-05" as a text and "1.0e-05" as a number.
  const size_t exponent = digits.find('e');
  if (exponent != std::string::npos && digits.find('.') == std::string::npos) digits.insert(exponent, ".0");
  return scalar_node(digits, false);
}

ConfigNode ConfigNode::of(int value) { return scalar_node(std::to_string(value), false); }
ConfigNode ConfigNode::of(bool value) { return scalar_node(value ? "true" : "false", false); }
ConfigNode ConfigNode::of(const std::string& value) { return scalar_node(value, true); }

}  // namespace drape
