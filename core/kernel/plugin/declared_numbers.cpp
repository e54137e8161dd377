#include "core/kernel/plugin/declared_numbers.h"

#include "core/kernel/plugin/parameters.h"

namespace drape {

namespace {

using NodeKind = ConfigNode::Kind;

/// Index of a map's entry.
std::optional<std::size_t> entry_of(const ConfigNode& map, const std::string& name) {
  for (std::size_t i = 0; i < map.entries.size(); ++i)
    if (map.entries[i].first == name) return i;
  return std::nullopt;
}

}  // namespace

std::optional<DeclaredNumbers> DeclaredNumbers::find(const Schema& outermost, void* object,
                                                     const std::vector<std::string>& words) {
  DeclaredNumbers found;
  found.schema_ = &outermost;
  for (std::size_t k = 0; k < words.size(); ++k) {
    const Parameter* p = parameter_named(*found.schema_, words[k]);
    if (!p) return std::nullopt;
    const std::string label = "\"" + p->name + "\"";
    const bool is_list = p->type.is_list(), is_map = p->type.is_map();
    std::optional<std::size_t> item;
    if ((is_list || is_map) && k + 1 < words.size()) {
      const ConfigNode all = p->write(object);
      item = is_list ? all.index_of(words[++k]) : entry_of(all, words[++k]);
      if (!item) return std::nullopt;
      if (is_map && k + 2 == words.size() && words[k + 1] == "value") ++k;
    }
    if (p->section) {
      if (is_list && !item) return std::nullopt;
      found.sections_.push_back({p, item.value_or(0)});
      object = p->section_in(object, item.value_or(0));
      found.schema_ = p->section.get();
      continue;
    }
    const ConfigNode all = p->write(object);
    const bool numeric = p->type.kind == ValueKind::number;
    if (k + 1 < words.size() || !numeric || (is_map && !item) || all.kind == NodeKind::null)
      return std::nullopt;
    found.parameter_ = p;
    found.first_ = item.value_or(0);
    found.count_ = is_list && !item ? all.items.size() : 1;
    for (std::size_t c = found.first_; c < found.first_ + found.count_; ++c)
      found.labels_.push_back(is_list  ? "item " + std::to_string(c + 1) + " of " + label
                              : is_map ? "\"" + all.entries[c].first + "\" in " + p->name
                                       : label);
    return found;
  }
  return std::nullopt;
}

void* DeclaredNumbers::owner(void* object) const {
  for (const Section& section : sections_) object = section.parameter->section_in(object, section.item);
  return object;
}

double* DeclaredNumbers::at(void* object, std::size_t k) const {
  return parameter_->number(owner(object), first_ + k);
}

void DeclaredNumbers::set(void* object, const double* values, ConfigErrors& errors) const {
  const std::size_t before = errors.size();
  for (std::size_t c = 0; c < count_; ++c)
    if (const std::string fault = number_fault(*parameter_, values[c]); !fault.empty())
      errors.push_back({{}, labels_[c] + " must be " + fault + ", not " + ConfigNode::of(values[c]).scalar});
  if (errors.size() != before) return;
  void* own = owner(object);
  for (std::size_t c = 0; c < count_; ++c) *parameter_->number(own, first_ + c) = values[c];
  if (const std::string fault = schema_->unread_fault(*parameter_, own); !fault.empty())
    errors.push_back({{}, fault});
}

}  // namespace drape
