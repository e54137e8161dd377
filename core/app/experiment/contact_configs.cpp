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

/// The keys by which the model knows its obstacles.
std::vector<std::string> identifying_keys(const RegistryEntry& model) {
  std::vector<std::string> keys;
  for (const Parameter& list : model.schema.parameters)
    if (list.from_experiment && list.section)
      for (const Parameter& p : list.section->parameters)
        if (p.identifies_item) keys.push_back(p.name);
  return keys;
}

/// The first key of an obstacle by which the model knows it; "" without one.
std::string known_key(const RegistryEntry& model, const ConfigNode& obstacle) {
  for (const std::string& key : identifying_keys(model))
    if (obstacle.find(key)) return key;
  return "";
}

/// "obstacles[2] (ball)".
std::string label_of(const ConfigNode& obstacle, std::size_t index) {
  const ConfigNode* name = obstacle.find("name");
  return "obstacles[" + std::to_string(index) + "]" +
         (name && !name->scalar.empty() ? " (" + excerpt(name->scalar) + ")" : "");
}

/// Why no model of an experiment takes the obstacle, with a remedy.
std::string refusal(const Registry& registry, const ConfigNode& obstacle, std::size_t index) {
  std::vector<std::string> keys;
  for (const RegistryEntry* model : registry.of_kind("contact")) {
    if (const std::string key = known_key(*model, obstacle); !key.empty())
      return label_of(obstacle, index) + ": no contact model of this experiment takes \"" + key + "\"; add " +
             model->name + " to \"contact\"";
    for (const std::string& key : identifying_keys(*model)) keys.push_back(key);
  }
  if (keys.empty()) return label_of(obstacle, index) + ": no contact model that is loaded takes obstacles";
  return label_of(obstacle, index) + " must be a map with " + quoted_choice(keys);
}

bool has_friction(const RegistryEntry& model) {
  const Parameter* friction = parameter_named(model.schema, "friction");
  return friction && friction->from_experiment;
}

/// Friction that no model of an experiment has, which would be ignored.
void check_friction(const Experiment& e, const std::vector<const RegistryEntry*>& models,
                    ConfigErrors& errors) {
  const auto has = [](const RegistryEntry* model) { return !model || has_friction(*model); };
  const auto& keys = e.parameters.schedule.keys;
  const bool is_scheduled = std::ranges::find(keys, "friction", &ScheduleKey::parameter) != keys.end();
  if ((e.parameters.friction == 0 && !is_scheduled) || std::ranges::any_of(models, has)) return;
  std::vector<std::string> names;
  for (const RegistryEntry* model : e.registry->of_kind("contact"))
    if (has_friction(*model)) names.push_back(model->name);
  const Location& contact = e.parameters.contact.where;
  errors.push_back({contact.line > 0 ? contact : e.location_of("friction"),
                    "no contact model of this experiment has friction; set \"friction\" to 0" +
                        (names.empty() ? "" : ", or add " + quoted_choice(names) + " to \"contact\"")});
}

/// Each model sees every pair of the cloth and all of its obstacles, so a second one would count them twice.
void check_models(const std::vector<ConfigNode>& written, const std::vector<const RegistryEntry*>& models,
                  ConfigErrors& errors) {
  for (std::size_t k = 0; k < models.size(); ++k)
    if (models[k] && std::find(models.begin(), models.begin() + k, models[k]) != models.begin() + k)
      errors.push_back(
          {written[k].where, "\"contact\" lists " + models[k]->name + " twice; list each model once"});
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

/// Gives each obstacle to the first model that knows it.
void share_obstacles(const Registry& registry, const std::vector<ConfigNode>& obstacles,
                     const std::vector<const RegistryEntry*>& models,
                     std::vector<std::vector<std::size_t>>& obstacles_of, ConfigErrors& errors) {
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const auto takes = std::ranges::find_if(models, [&](const RegistryEntry* model) {
      return model && !known_key(*model, obstacles[i]).empty();
    });
    const auto all = registry.of_kind("contact");
    const auto other = std::ranges::find_if(all, [&](const RegistryEntry* model) {
      return takes != models.end() && model != *takes && !known_key(*model, obstacles[i]).empty();
    });
    if (other != all.end())
      errors.push_back({obstacles[i].where, label_of(obstacles[i], i) + " has both \"" +
                                                known_key(**takes, obstacles[i]) + "\" and \"" +
                                                known_key(**other, obstacles[i]) + "\"; keep one"});
    else if (takes != models.end())
      obstacles_of[takes - models.begin()].push_back(i);
    else if (std::ranges::find(models, nullptr) == models.end())  // else a model's name is wrong
      errors.push_back({obstacles[i].where, refusal(registry, obstacles[i], i)});
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
  check_models(written, models, errors);
  constexpr std::size_t most_obstacles = 10'000;
  if (p.obstacles.size() > most_obstacles)
    return errors.push_back(
        {e.location_of("obstacles"), "\"obstacles\" has " + std::to_string(p.obstacles.size()) +
                                         " entries, of at most " + std::to_string(most_obstacles) +
                                         "; a mesh can hold many bodies"});
  check_names(p.obstacles, errors);
  check_friction(e, models, errors);
  share_obstacles(*e.registry, p.obstacles, models, e.obstacles_of, errors);
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
