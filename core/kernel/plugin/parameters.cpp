#include "core/kernel/plugin/parameters.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <set>

#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"

namespace drape {
namespace {

using NodeKind = ConfigNode::Kind;

std::string with_unit(double value, const Parameter& p) {
  const std::string text = ConfigNode::of(value).scalar;
  return p.unit.empty() || p.unit == "1" ? text : text + " " + p.unit;
}

/// What a number must be to be a value of the parameter, or of an item of it, as "at least 0"; "" if it is.
std::string number_fault(const Parameter& p, const ConfigNode& node) {
  const double value = node.number;
  if (!std::isfinite(value)) return "a finite number";
  if (p.open_minimum && !(value > p.minimum)) return "above " + with_unit(p.minimum, p);
  if (!p.open_minimum && !(value >= p.minimum)) return "at least " + with_unit(p.minimum, p);
  if (p.open_maximum && !(value < p.maximum)) return "below " + with_unit(p.maximum, p);
  if (!p.open_maximum && !(value <= p.maximum)) return "at most " + with_unit(p.maximum, p);
  return "";
}

/// What a scalar must be if it is not, else "".
std::string scalar_fault(const ConfigNode& node, const Parameter& p) {
  if (p.type.kind == ValueKind::integer)
    return node.is_number() && parse_integer(node.scalar) ? number_fault(p, node) : "an integer";
  if (p.type.kind == ValueKind::number) {
    if (node.is_number()) return number_fault(p, node);
    return is_one_of(node.scalar, {".nan", ".inf", "-.inf"}) ? "a finite number" : "a number";
  }
  if (p.type.kind == ValueKind::boolean) return node.kind == NodeKind::boolean ? "" : "true or false";
  if (!node.is_scalar()) return p.choices.empty() ? "text" : quoted_choice(p.choices);
  return p.choices.empty() || is_one_of(node.scalar, p.choices) ? "" : quoted_choice(p.choices);
}

void check_scalar(const std::string& label, const ConfigNode& node, const Parameter& p,
                  ConfigErrors& errors) {
  const std::string fault = scalar_fault(node, p);
  if (fault.empty()) return;
  const std::string hint = node.is_scalar() ? did_you_mean(node.scalar, p.choices, "") : "";
  errors.push_back({node.where, label + " must be " + fault + ", not " + node.shown() +
                                    (hint.empty() ? "" : "; " + hint)});
}

void check_list(const ConfigNode& node, const Parameter& p, ConfigErrors& errors) {
  const std::string label = "\"" + p.name + "\"";
  std::string items = p.type.item().text() + "s";
  if (p.type.kind == ValueKind::section) items = "maps";
  if (p.type.kind == ValueKind::node)
    items = p.plugin_kind.empty() ? "values" : "plugins of kind " + p.plugin_kind;
  const std::string wanted = "a list of " + (p.type.size ? std::to_string(p.type.size) + " " : "") + items;
  if (node.kind != NodeKind::list) {
    errors.push_back({node.where, label + " must be " + wanted + ", not " + node.shown()});
  } else if (p.type.size && int(node.items.size()) != p.type.size) {
    errors.push_back(
        {node.where, label + " must be " + wanted + ", not of " + std::to_string(node.items.size())});
  } else if (p.type.of_scalars()) {
    for (size_t i = 0; i < node.items.size(); ++i)
      check_scalar("item " + std::to_string(i + 1) + " of " + label, node.items[i], p, errors);
  }
}

bool is_identifier(const std::string& text) {
  const auto letter = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
  return !text.empty() && !std::isdigit(static_cast<unsigned char>(text[0])) &&
         std::all_of(text.begin(), text.end(), letter);
}

/// A map of numbers: names to a number, or to a number and its unit.
void check_named_constants(const ConfigNode& node, const Parameter& p, ConfigErrors& errors) {
  if (node.kind != NodeKind::map && node.kind != NodeKind::null) {
    errors.push_back({node.where, "\"" + p.name + "\" must be a map of names and numbers, as in {a: 2, b: " +
                                      "{value: 3, unit: N/m}}, not " + node.shown()});
    return;
  }
  std::set<std::string> names;
  for (size_t i = 0; i < node.entries.size(); ++i) {
    const auto& [name, number] = node.entries[i];
    const std::string label = "\"" + excerpt(name) + "\" in " + p.name;
    if (!is_identifier(name))
      errors.push_back(
          {node.key_locations[i],
           label + " must be a name of letters, digits and underscores, not beginning with a digit"});
    if (!names.insert(name).second)
      errors.push_back({node.key_locations[i], label + " is given twice; remove one of them"});
    if (number.kind != NodeKind::map) {
      check_scalar(label, number, p, errors);
      continue;
    }
    for (size_t k = 0; k < number.entries.size(); ++k)
      if (const std::string& key = number.entries[k].first; key != "value" && key != "unit")
        errors.push_back({number.key_locations[k],
                          "unknown key \"" + excerpt(key) + "\" of " + label + "; known are value, unit"});
      else if (number.find(key) != &number.entries[k].second)
        errors.push_back({number.key_locations[k], "repeated key \"" + key + "\" of " + label});
    const ConfigNode *value = number.find("value"), *unit = number.find("unit");
    if (!value)
      errors.push_back({number.where, label + " has no \"value\""});
    else
      check_scalar(label, *value, p, errors);
    if (unit && !unit->is_scalar())
      errors.push_back({unit->where, "the unit of " + label + " must be text, as in N/m"});
  }
}

/// Whether the node is valid for `p.read`; if not, appends an error.
bool check(const ConfigNode& node, const Parameter& p, ConfigErrors& errors) {
  const size_t before = errors.size();
  if (p.type.nullable && node.kind == NodeKind::null) return true;
  if (p.type.is_list())
    check_list(node, p, errors);
  else if (p.type.is_map())
    check_named_constants(node, p, errors);
  else if (p.type.of_scalars())
    check_scalar("\"" + p.name + "\"", node, p, errors);
  return errors.size() == before;
}

/// The map that a section's shorthand stands for. set_path has expanded a shorthand to a map with the word as
/// `type` if it set another key of the section.
ConfigNode expand_shorthand(const ConfigNode& node, const Parameter& p) {
  ConfigNode map = node.as_map(p.shorthand_key);
  for (auto& [key, value] : map.entries)
    if (key == "type") key = p.shorthand_key;
  return map;
}

/// Path relative to the current folder, as paths on the command line are; for a list, each.
ConfigNode relative_path(const ConfigNode& node) {
  ConfigNode path = node;
  for (ConfigNode& item : path.items) item = relative_path(item);
  if (node.is_scalar() && !node.scalar.empty() && node.where.line > 0)
    path.scalar = (std::filesystem::path(node.where.file).parent_path() / node.scalar).string();
  return path;
}

/// The list of which a path has set single items, as in {2: -1}: the others are the object's own. Nothing if
/// the map names anything else.
std::optional<ConfigNode> completed(const ConfigNode& map, const Parameter& p, const void* object) {
  ConfigNode list = p.write(object);
  for (const auto& [key, item] : map.entries) {
    const auto index = parse_integer(key) ? list.index_of(key) : std::nullopt;
    if (!index || map.find(key) != &item) return std::nullopt;
    list.items[*index] = item;
  }
  list.where = map.where;
  return list;
}

}  // namespace

std::string ParameterType::text() const {
  constexpr const char* words[] = {"number", "integer", "boolean", "text", "section", "node"};
  std::string word = words[static_cast<int>(kind)];
  if (shape == Shape::one) return word;
  return (shape == Shape::list ? "list of " : "map of ") + word + "s";
}

void read_parameter(const Parameter& p, void* object, const ConfigNode& written, ConfigErrors& errors) {
  std::optional<ConfigNode> list;
  if (p.type.size > 0 && !written.entries.empty()) list = completed(written, p, object);
  const ConfigNode& value = list ? *list : written;
  if (!check(value, p, errors)) return;
  if (p.path)
    p.read(object, relative_path(value), errors);
  else if (!p.shorthand_key.empty())
    p.read(object, expand_shorthand(value, p), errors);
  else
    p.read(object, value, errors);
}

namespace parameter_detail {

void convert(const ConfigNode& node, double& value) { value = node.number; }
void convert(const ConfigNode& node, int& value) { value = parse_integer(node.scalar).value(); }
void convert(const ConfigNode& node, bool& value) { value = node.scalar == "true"; }
void convert(const ConfigNode& node, std::string& value) { value = node.scalar; }
void convert(const ConfigNode& node, NamedConstants& values) {
  values.all.clear();
  for (const auto& [name, written] : node.entries) {
    const bool with_unit = written.kind == NodeKind::map;
    NamedConstant& own = values.all.emplace_back();
    own.name = name;
    convert(with_unit ? *written.find("value") : written, own.value);
    if (const ConfigNode* unit = with_unit ? written.find("unit") : nullptr) own.unit = unit->scalar;
  }
}

ConfigNode to_node(const NamedConstants& values) {
  ConfigNode map(NodeKind::map);
  for (const NamedConstant& own : values.all) {
    ConfigNode number = ConfigNode::of(own.value);
    if (!own.unit.empty()) {
      ConfigNode with_unit;
      with_unit.add("value", number);
      with_unit.add("unit", ConfigNode::of(own.unit));
      number = std::move(with_unit);
    }
    map.add(own.name, std::move(number));
  }
  return map;
}

}  // namespace parameter_detail

}  // namespace drape
