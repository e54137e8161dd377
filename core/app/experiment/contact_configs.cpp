#include <algorithm>
#include <map>
#include <optional>

#include "core/app/experiment/read_experiment.h"
#include "core/app/files/yaml_file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/parameters.h"
#include "core/kernel/plugin/registry.h"

namespace drape {

namespace {

using NodeKind = ConfigNode::Kind;

/// The contact models as written.
std::vector<ConfigNode> contact_sections(const ExperimentParameters& p) {
  if (p.contact.kind == NodeKind::null) return {};
  return p.contact.kind == NodeKind::list ? p.contact.items : std::vector<ConfigNode>{p.contact};
}

/// The keys by which the registered contact models know their obstacles, and those models.
std::vector<std::pair<std::string, const RegistryEntry*>> identifying_keys(const Registry& registry) {
  std::vector<std::pair<std::string, const RegistryEntry*>> keys;
  for (const RegistryEntry* model : registry.of_kind("contact"))
    for (const Parameter& list : model->schema.parameters)
      if (list.from_experiment && list.section)
        for (const Parameter& p : list.section->parameters)
          if (p.identifies_item) keys.emplace_back(p.name, model);
  return keys;
}

bool has_friction(const RegistryEntry& model) {
  const Parameter* friction = parameter_named(model.schema, "friction");
  return friction && friction->from_experiment;
}

/// Friction that no model of an experiment has, which would be ignored.
void check_friction(const Experiment& e, const std::vector<const RegistryEntry*>& models,
                    ConfigErrors& errors) {
  const auto may_have = [](const RegistryEntry* model) { return !model || has_friction(*model); };
  const auto& keys = e.parameters.schedule.keys;
  const bool is_scheduled = std::ranges::find(keys, "friction", &ScheduleKey::parameter) != keys.end();
  if ((e.parameters.friction == 0 && !is_scheduled) || std::ranges::any_of(models, may_have)) return;
  std::vector<std::string> names;
  for (const RegistryEntry* model : e.registry->of_kind("contact"))
    if (has_friction(*model)) names.push_back(model->name);
  const Location& contact = e.parameters.contact.where;
  errors.push_back({contact.line > 0 ? contact : e.location_of("friction"),
                    "no contact model of this experiment has friction; set \"friction\" to 0" +
                        (names.empty() ? "" : ", or add " + quoted_choice(names) + " to \"contact\"")});
}

/// A path of keys finds an obstacle by its name, so no two have the same.
void check_names(const std::vector<ConfigNode>& obstacles, ConfigErrors& errors) {
  std::map<std::string, std::size_t> named;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const ConfigNode* name = obstacles[i].find("name");
    if (!name || !name->is_scalar() || name->scalar.empty()) continue;
    if (parse_integer(name->scalar))
      errors.push_back({name->where, "\"" + excerpt(name->scalar) +
                                         "\" cannot be an obstacle's name: in paths a number is its index; "
                                         "begin it with a letter"});
    if (const auto [first, is_new] = named.try_emplace(name->scalar, i); !is_new)
      errors.push_back({name->where, "\"" + excerpt(name->scalar) + "\" is also the name of obstacles[" +
                                         std::to_string(first->second) + "]; give each obstacle its own"});
  }
}

/// Gives each obstacle to the one contact model that knows a key of it, of `models`, the experiment's.
void share_obstacles(Experiment& e, const std::vector<const RegistryEntry*>& models, ConfigErrors& errors) {
  const bool all_exist = std::ranges::find(models, nullptr) == models.end();
  const auto keys = identifying_keys(*e.registry);
  std::vector<std::string> words;
  for (const auto& [key, model] : keys) words.push_back(key);
  for (std::size_t i = 0; i < e.parameters.obstacles.size(); ++i) {
    const ConfigNode& obstacle = e.parameters.obstacles[i];
    const auto is_in = [&](const auto& key) { return obstacle.find(key.first) != nullptr; };
    const auto own = std::ranges::find_if(keys, is_in);
    const auto other = std::find_if(own, keys.end(),
                                    [&](const auto& key) { return key.second != own->second && is_in(key); });
    const auto taker = own == keys.end() ? models.end() : std::ranges::find(models, own->second);
    std::string fault;
    if (other != keys.end())
      fault = " has both \"" + own->first + "\" and \"" + other->first + "\"; keep one";
    else if (taker != models.end())
      e.obstacles_of[taker - models.begin()].push_back(i);
    else if (all_exist && own != keys.end())
      fault = ": no contact model of this experiment takes \"" + own->first + "\"; add " + own->second->name +
              " to \"contact\"";
    else if (all_exist)
      fault = keys.empty() ? ": no contact model that is loaded takes obstacles"
                           : " must be a map with " + quoted_choice(words);
    if (fault.empty()) continue;
    const ConfigNode* name = obstacle.find("name");
    errors.push_back({obstacle.where,
                      "obstacles[" + std::to_string(i) + "]" +
                          (name && !name->scalar.empty() ? " (" + excerpt(name->scalar) + ")" : "") + fault});
  }
}

/// Takes out of a model's resolved section what is the experiment's: its obstacles go back to their places.
void take_shared(const RegistryEntry& model, const std::vector<std::size_t>& own, ConfigNode& section,
                 std::vector<ConfigNode>& obstacles) {
  for (const Parameter& shared : model.schema.parameters) {
    if (!shared.from_experiment) continue;
    const ConfigNode* list = shared.section ? section.find(shared.name) : nullptr;
    for (std::size_t k = 0; list && k < list->items.size(); ++k) obstacles[own[k]] = list->items[k];
    section.remove(shared.name);
  }
}

}  // namespace

ConfigNode contact_section(const Experiment& e, const ExperimentParameters& p, std::size_t k,
                           ConfigErrors& errors) {
  ConfigNode section = contact_sections(p)[k].as_map("type");
  const RegistryEntry* model = e.registry->find("contact", section.plugin_name());
  if (!model) return section;
  for (const Parameter& shared : model->schema.parameters) {
    if (!shared.from_experiment) continue;
    while (const std::optional<Location> where = section.remove(shared.name))
      errors.push_back({*where, "\"" + shared.name + "\" in " + model->name +
                                    " belongs at the top of the experiment, once for all contact models"});
    ConfigNode value = ConfigNode::of(p.friction);
    if (shared.section) {
      value = ConfigNode(NodeKind::list);
      for (const std::size_t i : e.obstacles_of[k]) value.items.push_back(p.obstacles[i]);
    }
    section.add(shared.name, value);
  }
  return section;
}

void make_contacts(Experiment& e, ConfigErrors& errors) {
  const ExperimentParameters& p = e.parameters;
  const std::vector<ConfigNode> written = contact_sections(p);
  std::vector<const RegistryEntry*> models;
  for (const ConfigNode& node : written) models.push_back(e.registry->find("contact", node.plugin_name()));
  e.obstacles_of.resize(written.size());
  // Each model sees every pair of the cloth and all of its obstacles: a second one would count them twice.
  for (std::size_t k = 0; k < models.size(); ++k)
    if (models[k] && std::find(models.begin(), models.begin() + k, models[k]) != models.begin() + k)
      errors.push_back(
          {written[k].where, "\"contact\" lists " + models[k]->name + " twice; list each model once"});
  constexpr std::size_t most_obstacles = 10'000;
  if (p.obstacles.size() > most_obstacles)
    return errors.push_back(
        {e.location_of("obstacles"), "\"obstacles\" has " + std::to_string(p.obstacles.size()) +
                                         " entries, of at most " + std::to_string(most_obstacles) +
                                         "; a mesh can hold many bodies"});
  check_names(p.obstacles, errors);
  check_friction(e, models, errors);
  share_obstacles(e, models, errors);
  ConfigNode sections(NodeKind::list), obstacles(NodeKind::list);
  obstacles.items = p.obstacles;
  for (std::size_t k = 0; k < written.size(); ++k) {
    ConfigNode& resolved = sections.items.emplace_back();
    e.contacts.push_back(
        make_from<ContactModel>(*e.registry, contact_section(e, p, k, errors), errors, &resolved));
    if (models[k]) take_shared(*models[k], e.obstacles_of[k], resolved, obstacles.items);
  }
  const bool is_one = p.contact.kind != NodeKind::list && !sections.items.empty();
  set_path(e.resolved, "contact", is_one ? sections.items[0] : sections);
  set_path(e.resolved, "obstacles", obstacles);
}

}  // namespace drape
