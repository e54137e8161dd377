#include "core/kernel/plugin/parameter_path.h"

#include <algorithm>

namespace drape {

const Parameter* parameter_named(const Schema& schema, const std::string& name) {
  for (const Parameter& p : schema.parameters)
    if (p.name == name) return &p;
  return nullptr;
}

std::optional<ParameterPath> ParameterPath::find(const Schema& outermost, void* object,
                                                 const std::vector<std::string>& words) {
  ParameterPath path;
  const Schema* schema = &outermost;
  for (std::size_t k = 0; k < words.size(); ++k) {
    const Parameter* p = parameter_named(*schema, words[k]);
    if (!p) return std::nullopt;
    std::optional<std::size_t> item;
    if (p->type.starts_with("list of ") && k + 1 < words.size()) {
      item = p->write(object).index_of(words[++k]);
      if (!item) return std::nullopt;
    }
    if (p->type == "map of numbers" && k + 1 < words.size()) {
      const ConfigNode map = p->write(object);
      const std::string& name = words[++k];
      const auto found = std::find_if(map.entries.begin(), map.entries.end(),
                                      [&](const auto& entry) { return entry.first == name; });
      if (found == map.entries.end()) return std::nullopt;
      item = static_cast<std::size_t>(found - map.entries.begin());
      if (k + 2 == words.size() && words[k + 1] == "value") ++k;
    }
    if (!p->section) {
      if (k + 1 < words.size()) return std::nullopt;
      path.parameter_ = p;
      path.item_ = item;
      return path;
    }
    if (p->type != "section" && !item) return std::nullopt;
    path.sections_.push_back({p, item.value_or(0)});
    object = p->section_in(object, item.value_or(0));
    schema = p->section.get();
  }
  return std::nullopt;
}

void ParameterPath::set(void* object, const ConfigNode& value, ConfigErrors& errors) const {
  for (const Section& section : sections_) object = section.parameter->section_in(object, section.item);
  if (!item_) return read_parameter(*parameter_, object, value, errors);
  ConfigNode all = parameter_->write(object);
  ConfigNode* number =
      all.kind == ConfigNode::Kind::map ? &all.entries.at(*item_).second : &all.items.at(*item_);
  if (number->kind == ConfigNode::Kind::map) number = &number->entries[0].second;  // beside its unit
  *number = value;
  read_parameter(*parameter_, object, all, errors);
}

}  // namespace drape
