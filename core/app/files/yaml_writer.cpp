#include <algorithm>

#include "core/app/files/yaml_file.h"

namespace drape {
namespace {

using Kind = ConfigNode::Kind;

bool is_flat(const ConfigNode& node) {
  const auto& items = node.items;
  return std::all_of(items.begin(), items.end(), [](const ConfigNode& item) {
    return item.kind == Kind::scalar || item.kind == Kind::null;
  });
}

bool fits_a_line(const ConfigNode& node) {
  const bool empty = node.items.empty() && node.entries.empty();
  return empty || (node.kind == Kind::list && is_flat(node));
}

/// Writes the lines of a list or map; the first continues the line it is on, after `- ` or nothing.
void write_block(const ConfigNode& node, const std::string& indent, std::string& text) {
  bool first = true;
  const auto begin_line = [&] {
    if (!first) text += indent;
    first = false;
  };
  for (const ConfigNode& item : node.items) {
    begin_line();
    text += "- ";
    if (fits_a_line(item))
      text += item.one_line() + "\n";
    else
      write_block(item, indent + "  ", text);
  }
  for (const auto& [key, value] : node.entries) {
    begin_line();
    text += ConfigNode::of(key).one_line() + ":";
    if (fits_a_line(value)) {
      text += " " + value.one_line() + "\n";
    } else {
      text += "\n" + indent + "  ";
      write_block(value, indent + "  ", text);
    }
  }
}

}  // namespace

std::string to_yaml(const ConfigNode& node) {
  if (fits_a_line(node)) return node.one_line() + "\n";
  std::string text;
  write_block(node, "", text);
  return text;
}

}  // namespace drape
