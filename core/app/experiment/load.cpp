#include "core/app/experiment/load.h"

#include <algorithm>

#include "core/app/experiment/experiment_path.h"
#include "core/app/experiment/read_experiment.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/make.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

namespace {

/// Whether contact models are made from a section of the experiment.
bool is_of_contact(const std::string& section) {
  return is_one_of(section, {"contact", "obstacles", "friction"});
}

/// A key's value as its parameter has it.
ConfigNode node_of(const ScheduleKey& key, std::span<const double> value) {
  if (key.written.items[0].kind != ConfigNode::Kind::list) return ConfigNode::of(value[0]);
  return parameter_detail::to_node(std::vector<double>(value.begin(), value.end()));
}

/// What an experiment's source gives with these values in it.
ExperimentParameters parameters_with(const Experiment& e, const std::vector<LoadValue>& values,
                                     ConfigErrors& errors) {
  ConfigNode source(ConfigNode::Kind::map);  // without the schedule, of which each load would have a copy
  source.where = e.source.where;
  for (std::size_t i = 0; i < e.source.entries.size(); ++i) {
    if (e.source.entries[i].first == "schedule") continue;
    source.entries.push_back(e.source.entries[i]);
    source.key_locations.push_back(e.source.key_locations[i]);
  }
  for (const LoadValue& own : values) set_parameter(source, own.path, own.value, {}, errors);
  return parameters_of(source, errors);
}

}  // namespace

bool ScheduleKey::is_of_contact() const { return drape::is_of_contact(section); }

std::vector<LoadValue> load_values(const std::vector<ScheduleKey>& keys, std::span<const double> values,
                                   std::span<const double> before) {
  std::vector<LoadValue> all;
  for (std::size_t first = 0; const ScheduleKey& key : keys) {
    const std::size_t count = key.values[0].size();
    const auto own = values.subspan(first, count);
    all.push_back({key.parameter, key.section, key.item, node_of(key, own),
                   !std::ranges::equal(own, before.subspan(first, count))});
    first += count;
  }
  return all;
}

void set_values(const Experiment& e, const std::vector<LoadValue>& values, Load& load, ConfigErrors& errors) {
  ExperimentParameters now = parameters_with(e, values, errors);
  if (!errors.empty()) return;
  const auto has_changed = [&](const auto& is_meant) {
    return std::ranges::any_of(values, [&](const LoadValue& own) { return own.changes && is_meant(own); });
  };
  for (std::size_t k = 0; k < now.energies.size(); ++k)
    if (has_changed([&](const LoadValue& own) { return own.section == "energies" && own.item == k; })) {
      std::shared_ptr<const Energy>& energy = load.energies[k].energy;
      energy = make_from<Energy>(*e.registry, now.energies[k], errors, nullptr, energy.get());
    }
  for (std::size_t k = 0; k < load.contacts.size(); ++k)
    if (has_changed([&](const LoadValue& own) {
          return own.section == "friction" || (own.section == "contact" && own.item == k) ||
                 (own.section == "obstacles" && std::ranges::count(e.obstacles_of[k], own.item) > 0);
        })) {
      std::shared_ptr<ContactModel>& contact = load.contacts[k];
      contact = make_from<ContactModel>(*e.registry, contact_section(e, now, k, errors), errors, nullptr,
                                        contact.get());
    }
  const auto is_of_parameters = [](const LoadValue& own) {
    return !is_of_contact(own.section) && own.section != "energies";
  };
  if (!has_changed(is_of_parameters)) return;
  for (std::size_t k = 0; k < now.pins.size(); ++k)  // which a pattern's source does not have
    now.pins[k].label_edges = e.parameters.pins[k].label_edges;
  for (std::size_t k = 0; k < now.handles.size(); ++k)
    now.handles[k].label_edges = e.parameters.handles[k].label_edges;
  load.parameters = std::make_shared<const ExperimentParameters>(std::move(now));
}

}  // namespace drape
