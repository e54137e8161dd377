#include "core/app/report/model_keys.h"

#include <algorithm>
#include <optional>

namespace drape {

namespace {

using NodeKind = ConfigNode::Kind;

constexpr const char* model_keys[] = {"cloth",    "levels",  "material", "pins",      "handles", "schedule",
                                      "energies", "refiner", "contact",  "obstacles", "friction"};

/// The part of an experiment below a key, without the record of where a material's numbers are from; empty if
/// it lacks the key.
std::optional<ConfigNode> part_of(const ConfigNode& config, const std::string& key) {
  const ConfigNode* node = config.find(key);
  if (!node) return std::nullopt;
  ConfigNode part = *node;
  if (key == "material") std::erase_if(part.entries, [](const auto& e) { return e.first == "from_fabric"; });
  return part;
}

/// The word that names an item of a list in a path: its type or name, or its index.
std::string word_of(const ConfigNode& item, std::size_t index) {
  for (const char* key : {"type", "name"})
    if (const ConfigNode* word = item.find(key); word && !word->scalar.empty()) return word->scalar;
  return std::to_string(index);
}

void add_differences(const ConfigNode& a, const ConfigNode& b, const std::string& path,
                     std::vector<std::string>& differing) {
  const bool lists = a.kind == NodeKind::list && b.kind == NodeKind::list && a.items.size() == b.items.size();
  const bool of_maps = lists && std::all_of(a.items.begin(), a.items.end(), [](const ConfigNode& item) {
                         return item.kind == NodeKind::map;
                       });
  if (of_maps) {
    for (std::size_t i = 0; i < a.items.size(); ++i)
      add_differences(a.items[i], b.items[i], path + "." + word_of(a.items[i], i), differing);
  } else if (a.kind == NodeKind::map && b.kind == NodeKind::map) {
    for (const auto& [key, value] : a.entries)
      if (const ConfigNode* other = b.find(key)) add_differences(value, *other, path + "." + key, differing);
  } else if (a.one_line() != b.one_line()) {
    differing.push_back(path);
  }
}

}  // namespace

std::string model_of(const ConfigNode& config) {
  std::string text;
  for (const char* key : model_keys)
    if (const auto node = part_of(config, key)) text += std::string(key) + ": " + node->one_line() + "\n";
  return text;
}

std::vector<std::string> differing_model_keys(const ConfigNode& a, const ConfigNode& b) {
  std::vector<std::string> differing;
  for (const char* key : model_keys)
    if (const auto of_a = part_of(a, key), of_b = part_of(b, key); of_a && of_b)
      add_differences(*of_a, *of_b, key, differing);
  return differing;
}

}  // namespace drape
