#include "core/app/experiment/contact_configs.h"

#include <algorithm>
#include <map>

#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/parameter_path.h"

namespace drape {

namespace {

using NodeKind = ConfigNode::Kind;

const RegistryEntry* model_of(const Registry& registry, const ConfigNode& node) {
  const ConfigNode* type = node.kind == NodeKind::map ? node.find("type") : &node;
  return type ? registry.find("contact", type->scalar) : nullptr;
}

/// The model's declared list of obstacles, or null.
const Parameter* obstacles_of(const RegistryEntry& model) {
  for (const Parameter& p : model.schema.parameters)
    if (p.from_experiment && p.section) return &p;
  return nullptr;
}

/// The first key of an obstacle by which the model knows it; "" without one.
std::string known_key(const RegistryEntry& model, const ConfigNode& obstacle) {
  const Parameter* list = obstacles_of(model);
  if (!list) return "";
  for (const Parameter& p : list->section->parameters)
    if (p.identifies_item && obstacle.find(p.name)) return p.name;
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
    const Parameter* list = obstacles_of(*model);
    for (std::size_t k = 0; list && k < list->section->parameters.size(); ++k)
      if (const Parameter& p = list->section->parameters[k]; p.identifies_item) keys.push_back(p.name);
  }
  if (keys.empty()) return label_of(obstacle, index) + ": no contact model that is loaded takes obstacles";
  return label_of(obstacle, index) + " must be a map with " + quoted_choice(keys);
}

/// A model's own section, as a map with `type`, without what stands at the top of the experiment.
ConfigNode own_section(const RegistryEntry& model, const ConfigNode& written, ConfigErrors& errors) {
  ConfigNode own;
  own.where = written.where;
  if (written.kind != NodeKind::map) own.add("type", written);
  for (std::size_t i = 0; i < written.entries.size(); ++i) {
    const auto& [key, value] = written.entries[i];
    const Parameter* parameter = parameter_named(model.schema, key);
    if (parameter && parameter->from_experiment) {
      errors.push_back({written.key_locations[i], "\"" + key + "\" in " + model.name +
                                                      " belongs at the top of the experiment, once for all "
                                                      "contact models"});
      continue;
    }
    own.add(key, value);
    own.key_locations.back() = written.key_locations[i];
  }
  return own;
}

bool has_friction(const RegistryEntry& model) {
  const auto& parameters = model.schema.parameters;
  return std::any_of(parameters.begin(), parameters.end(),
                     [](const Parameter& p) { return p.from_experiment && p.name == "friction"; });
}

/// Friction that no model of an experiment has, which would be ignored.
void check_friction(const Registry& registry, const ExperimentParameters& p,
                    const std::vector<const RegistryEntry*>& models, ConfigErrors& errors) {
  const auto has = [](const RegistryEntry* model) { return !model || has_friction(*model); };
  if (p.friction == 0 || std::any_of(models.begin(), models.end(), has)) return;
  std::vector<std::string> names;
  for (const RegistryEntry* model : registry.of_kind("contact"))
    if (has_friction(*model)) names.push_back(model->name);
  Location where = p.contact.where;
  if (where.line == 0) where.key = "friction";
  errors.push_back(
      {where, "no contact model of this experiment has friction; set \"friction\" to 0" +
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
    if (!name || name->kind != NodeKind::scalar || name->scalar.empty()) continue;
    if (const auto [first, is_new] = named.try_emplace(name->scalar, i); !is_new)
      errors.push_back({name->where, "\"" + excerpt(name->scalar) + "\" is also the name of obstacles[" +
                                         std::to_string(first->second) + "]; give each obstacle its own"});
  }
}

}  // namespace

std::vector<ContactConfig> contact_configs(const Registry& registry, const ExperimentParameters& p,
                                           ConfigErrors& errors) {
  std::vector<ConfigNode> written =
      p.contact.kind == NodeKind::list ? p.contact.items : std::vector<ConfigNode>{p.contact};
  if (p.contact.kind == NodeKind::null) written = {ConfigNode::of("none")};
  std::vector<ContactConfig> configs;
  std::vector<const RegistryEntry*> models;
  for (const ConfigNode& node : written) {
    models.push_back(model_of(registry, node));
    configs.push_back({models.back() ? own_section(*models.back(), node, errors) : node, {}});
  }
  check_models(written, models, errors);
  check_names(p.obstacles, errors);
  check_friction(registry, p, models, errors);
  for (std::size_t i = 0; i < p.obstacles.size(); ++i) {
    const auto takes = std::find_if(models.begin(), models.end(), [&](const RegistryEntry* model) {
      return model && !known_key(*model, p.obstacles[i]).empty();
    });
    if (takes != models.end())
      configs[takes - models.begin()].obstacles.push_back(i);
    else if (std::find(models.begin(), models.end(), nullptr) ==
             models.end())  // else a model's name is wrong
      errors.push_back({p.obstacles[i].where, refusal(registry, p.obstacles[i], i)});
  }
  for (std::size_t k = 0; k < configs.size(); ++k) {
    if (!models[k]) continue;
    for (const Parameter& parameter : models[k]->schema.parameters) {
      if (!parameter.from_experiment) continue;
      ConfigNode value = ConfigNode::of(p.friction);
      if (parameter.section) {
        value = ConfigNode();
        value.kind = NodeKind::list;
        for (const std::size_t i : configs[k].obstacles) value.items.push_back(p.obstacles[i]);
      }
      configs[k].node.add(parameter.name, std::move(value));
    }
  }
  return configs;
}

std::vector<std::size_t> obstacle_order(const Registry& registry, const ExperimentParameters& p) {
  ConfigErrors reported;  // when the experiment was read
  std::vector<std::size_t> order;
  for (const ContactConfig& config : contact_configs(registry, p, reported))
    order.insert(order.end(), config.obstacles.begin(), config.obstacles.end());
  return order;
}

std::vector<std::string> obstacle_names(const Registry& registry, const ExperimentParameters& p) {
  std::vector<std::string> names;
  for (const std::size_t i : obstacle_order(registry, p)) {
    const ConfigNode* name = p.obstacles[i].find("name");
    names.push_back(name ? name->scalar : "");
  }
  return names;
}

void split_resolved(const Registry& registry, const ContactConfig& config, ConfigNode& resolved,
                    std::vector<ConfigNode>& obstacles) {
  const RegistryEntry* model = model_of(registry, resolved);
  if (!model) return;
  ConfigNode own;
  for (const auto& [key, value] : resolved.entries) {
    const Parameter* parameter = parameter_named(model->schema, key);
    if (!parameter || !parameter->from_experiment) {
      own.add(key, value);
      continue;
    }
    for (std::size_t k = 0; k < value.items.size(); ++k)
      obstacles.at(config.obstacles.at(k)) = value.items[k];
  }
  resolved = std::move(own);
}

}  // namespace drape
