#include "core/app/experiment/load_schedule.h"

#include <algorithm>
#include <stdexcept>

#include "core/app/experiment/boundary_conditions.h"
#include "core/app/experiment/experiment_path.h"
#include "core/app/experiment/following_pins.h"

namespace drape {

namespace {

const Schema& experiment_schema() {
  static const Schema schema = schema_of<ExperimentParameters>();
  return schema;
}

void throw_first(const ConfigErrors& errors) {
  if (!errors.empty()) throw std::runtime_error(errors[0].message);
}

}  // namespace

LoadSchedule::LoadSchedule(const Experiment& e, const Scene& scene)
    : hierarchy_(scene.hierarchy),
      placed_(scene.placed),
      following_(scene.following),
      keys_(e.parameters.schedule),
      increment_count_(e.parameters.schedule.steps),
      equilibrates_(e.parameters.schedule.equilibrate) {
  auto parameters = std::make_shared<ExperimentParameters>(e.parameters);
  ConfigErrors errors;
  ExperimentParameters resolved;
  experiment_schema().read(&resolved, e.resolved, errors);
  const std::vector<ContactConfig> contacts = contact_configs(*e.registry, resolved, errors);
  throw_first(errors);
  std::size_t first = 0;
  for (std::size_t k = 0; k < e.parameters.schedule.keys.size(); ++k) {
    const std::string& name = e.parameters.schedule.keys[k].parameter;
    for (const Target& target : targets_of(e, contacts, words_of_path(e.resolved, name))) {
      Section& section = section_of(e, contacts, target);
      const bool of_plugin = section.plugin.entry != nullptr;
      const auto path =
          ParameterPath::find(of_plugin ? section.plugin.entry->schema : experiment_schema(),
                              of_plugin ? section.plugin.values.get() : parameters.get(), target.words);
      if (!path) throw std::runtime_error("the schedule's key \"" + name + "\" names no parameter");
      section.keys.push_back({k, first, *path});
    }
    first += keys_.count(k);
  }
  first_ = std::make_shared<const LoadState>(
      LoadState{keys_.first(), std::move(parameters), scene.energies, e.contacts});
}

std::vector<LoadSchedule::Target> LoadSchedule::targets_of(const Experiment& e,
                                                           const std::vector<ContactConfig>& contacts,
                                                           const std::vector<std::string>& words) {
  const std::string& key = words[0];
  const auto words_from = [&](std::size_t used) {
    return std::vector<std::string>(words.begin() + static_cast<std::ptrdiff_t>(used), words.end());
  };
  const auto item = [&] {
    const auto index = words.size() > 1 ? e.resolved.find(key)->index_of(words[1]) : std::nullopt;
    if (!index) throw std::runtime_error("the schedule's keys name no item of \"" + key + "\"");
    return *index;
  };
  std::vector<Target> targets;
  if (key == "friction") {
    for (std::size_t k = 0; k < contacts.size(); ++k)
      if (contacts[k].node.find(key)) targets.push_back({Section::contact, k, words});
  } else if (key == "obstacles") {
    const std::size_t of_experiment = item();
    for (std::size_t k = 0; k < contacts.size(); ++k)
      for (std::size_t i = 0; i < contacts[k].obstacles.size(); ++i) {
        if (contacts[k].obstacles[i] != of_experiment) continue;
        std::vector<std::string> within = words_from(2);
        within.insert(within.begin(), {key, std::to_string(i)});
        targets.push_back({Section::contact, k, std::move(within)});
      }
  } else if (key == "energies" || key == "contact") {
    const bool is_list = e.resolved.find(key)->kind == ConfigNode::Kind::list;
    targets.push_back({key == "contact" ? Section::contact : Section::energy, is_list ? item() : 0,
                       words_from(is_list ? 2 : 1)});
  } else {
    targets.push_back({key == "pins"      ? Section::pins
                       : key == "handles" ? Section::handles
                                          : Section::material,
                       0, words});
  }
  return targets;
}

LoadSchedule::Section& LoadSchedule::section_of(const Experiment& e,
                                                const std::vector<ContactConfig>& contacts,
                                                const Target& target) {
  for (Section& section : sections_)
    if (section.kind == target.kind && section.item == target.item) return section;
  ConfigErrors errors;
  PluginParameters plugin;
  if (target.kind == Section::energy)
    plugin = read_plugin_parameters(*e.registry, "energy", e.resolved.find("energies")->items[target.item],
                                    errors);
  if (target.kind == Section::contact)
    plugin = read_plugin_parameters(*e.registry, "contact", contacts[target.item].node, errors);
  throw_first(errors);
  return sections_.emplace_back(Section{target.kind, target.item, std::move(plugin)});
}

bool LoadSchedule::differs(const Section& section, const std::vector<double>& a,
                           const std::vector<double>& b) const {
  return std::any_of(section.keys.begin(), section.keys.end(), [&](const Key& key) {
    const auto first = static_cast<std::ptrdiff_t>(key.first),
               last = first + static_cast<std::ptrdiff_t>(keys_.count(key.index));
    return !std::equal(a.begin() + first, a.begin() + last, b.begin() + first);
  });
}

void LoadSchedule::write(const Section& section, const std::vector<double>& values, void* object) const {
  ConfigErrors errors;
  for (const Key& key : section.keys) key.path.set(object, keys_.node(key.index, &values[key.first]), errors);
  throw_first(errors);
}

std::shared_ptr<const LoadState> LoadSchedule::at(std::vector<double> values, const LoadState& before) const {
  auto load = std::make_shared<LoadState>(before);
  std::shared_ptr<ExperimentParameters> parameters;  // once a section of the experiment's own differs
  bool new_handles = false;
  ConfigErrors errors;
  for (const Section& section : sections_) {
    if (!differs(section, values, before.values)) continue;
    if (!section.plugin.entry) {
      if (!parameters) parameters = std::make_shared<ExperimentParameters>(*before.parameters);
      write(section, values, parameters.get());
      new_handles = new_handles || section.kind == Section::handles;
      continue;
    }
    const PluginParameters own{section.plugin.entry,
                               section.plugin.entry->schema.copy(section.plugin.values.get())};
    write(section, values, own.values.get());
    if (section.kind == Section::energy) {
      auto& energy = load->energies[section.item].energy;
      energy = std::static_pointer_cast<Energy>(make_plugin(own, {}, errors, energy.get()));
    } else {
      auto& contact = load->contacts[section.item];
      contact = std::static_pointer_cast<ContactModel>(make_plugin(own, {}, errors, contact.get()));
    }
    throw_first(errors);
  }
  if (parameters) load->parameters = parameters;
  if (new_handles) load->energies.back().energy = handles_energy(*parameters, hierarchy_.levels[0], placed_);
  load->values = std::move(values);
  return load;
}

std::shared_ptr<const LevelModel> LoadSchedule::model(const LoadState& load, int level,
                                                      const LevelModel& before) const {
  const Level &own = hierarchy_.levels[level], &coarsest = hierarchy_.levels[0];
  const auto with = [&](std::vector<DirichletVertex> dirichlet, const LevelModel& shared) {
    return std::make_shared<const LevelModel>(own, load.parameters->material, load.energies,
                                              std::move(dirichlet), load.contacts, &shared);
  };
  std::vector<DirichletVertex> dirichlet =
      dirichlet_vertices(*load.parameters, own, coarsest, placed_[level]);
  if (following_[level].empty()) return with(std::move(dirichlet), before);
  const auto moved = with({}, before);  // where the obstacles are decides the targets
  move_targets(following_[level], moved->contacts(), dirichlet);
  return with(std::move(dirichlet), *moved);
}

}  // namespace drape
