#include "core/app/experiment/schedule_keys.h"

#include <algorithm>
#include <cmath>

#include "core/app/experiment/contact_configs.h"
#include "core/app/experiment/experiment_path.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/make.h"

namespace drape {

namespace {

using NodeKind = ConfigNode::Kind;

/// Sections whose parameters may change; the others choose the discretisation and the methods.
const std::vector<std::string> changeable = {"material", "energies", "contact", "obstacles",
                                             "friction", "pins",     "handles"};

/// A number or a list of them; empty for anything else.
std::vector<double> numbers_of(const ConfigNode& node) {
  std::vector<double> numbers;
  const auto add = [&](const ConfigNode& scalar) {
    const auto number = scalar.kind == NodeKind::scalar ? parse_number(scalar.scalar) : std::nullopt;
    if (number && std::isfinite(*number)) numbers.push_back(*number);
    return number && std::isfinite(*number);
  };
  if (node.kind != NodeKind::list) return add(node) ? numbers : std::vector<double>();
  for (const ConfigNode& item : node.items)
    if (!add(item)) return {};
  return numbers;
}

/// The values of a key at each of its times; empty unless all have equally many numbers.
std::vector<std::vector<double>> values_of(const KeyParameters& key) {
  if (key.values.kind != NodeKind::list || key.values.items.size() != key.times.size()) return {};
  std::vector<std::vector<double>> values;
  for (const ConfigNode& item : key.values.items) {
    values.push_back(numbers_of(item));
    if (values.back().empty() || values.back().size() != values[0].size()) return {};
  }
  return values;
}

std::vector<double> value_at(const KeyParameters& key, const std::vector<std::vector<double>>& values,
                             double time) {
  const auto next = std::upper_bound(key.times.begin(), key.times.end(), time);
  if (next == key.times.begin()) return values.front();
  const auto i = static_cast<std::size_t>(next - key.times.begin()) - 1;
  if (next == key.times.end() || key.interpolation == KeyInterpolation::step) return values[i];
  const double part = (time - key.times[i]) / (key.times[i + 1] - key.times[i]);
  std::vector<double> value = values[i];
  for (std::size_t c = 0; c < value.size(); ++c)
    value[c] = key.interpolation == KeyInterpolation::log
                   ? value[c] * std::pow(values[i + 1][c] / value[c], part)
                   : value[c] + part * (values[i + 1][c] - value[c]);
  return value;
}

double duration_of(const ScheduleParameters& p) {
  double duration = p.duration;
  for (const KeyParameters& key : p.keys)
    if (p.duration == 0 && !key.times.empty()) duration = std::max(duration, key.times.back());
  return duration;
}

/// Appends the faults of energies and contact models whose parameters differ from the experiment's in one
/// key.
void check_plugins(const Experiment& e, const ExperimentParameters& changed, ConfigErrors& errors) {
  for (std::size_t k = 0; k < std::min(changed.energies.size(), e.energies.size()); ++k)
    make_from<Energy>(*e.registry, changed.energies[k], errors, nullptr, e.energies[k].energy.get());
  const std::vector<ContactConfig> contacts = contact_configs(*e.registry, changed, errors);
  for (std::size_t k = 0; k < std::min(contacts.size(), e.contacts.size()); ++k)
    make_from<ContactModel>(*e.registry, contacts[k].node, errors, nullptr, e.contacts[k].get());
}

/// Appends an error for every key that sets what an earlier one sets.
void refuse_repeated_keys(const Experiment& e, ConfigErrors& errors) {
  const std::vector<KeyParameters>& keys = e.parameters.schedule.keys;
  std::vector<std::vector<std::string>> paths;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    paths.push_back(indexed_path(e.resolved, keys[k].parameter));
    for (std::size_t j = 0; j < k; ++j)
      if (std::equal(
              paths[j].begin(),
              paths[j].begin() + static_cast<std::ptrdiff_t>(std::min(paths[j].size(), paths[k].size())),
              paths[k].begin()))
        errors.push_back({e.source.find("schedule")->find("keys")->items[k].where,
                          "key \"" + excerpt(keys[k].parameter) + "\" sets what key \"" +
                              excerpt(keys[j].parameter) + "\" sets; remove one of them"});
  }
}

/// Appends an error for every key of a pin that follows an obstacle: the obstacle decides its targets.
void refuse_keys_of_following_pins(const Experiment& e, ConfigErrors& errors) {
  for (std::size_t k = 0; k < e.parameters.schedule.keys.size(); ++k) {
    const std::string& parameter = e.parameters.schedule.keys[k].parameter;
    const std::vector<std::string> path = indexed_path(e.resolved, parameter);
    const auto pin = path[0] == "pins" && path.size() > 1 ? parse_integer(path[1]) : std::nullopt;
    if (!pin || *pin < 0 || static_cast<std::size_t>(*pin) >= e.parameters.pins.size()) continue;
    if (const std::string& obstacle = e.parameters.pins[*pin].follow.obstacle; !obstacle.empty())
      errors.push_back({e.source.find("schedule")->find("keys")->items[k].where,
                        "key \"" + excerpt(parameter) + "\" changes pin " + std::to_string(*pin) +
                            ", which follows obstacle \"" + excerpt(obstacle) +
                            "\"; move the obstacle, or remove \"follow\""});
  }
}

/// The values of a key, and one between each two that differ: increments set such values too, also where a
/// step of a key has to be made in parts. None is a round fraction, which an integer might take.
std::vector<ConfigNode> with_values_between(const KeyParameters& key) {
  constexpr double fraction = 0.38196601125;
  std::vector<ConfigNode> nodes = key.values.items;
  const auto values = values_of(key);
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    if (values[i] == values[i + 1]) continue;
    ConfigNode between = key.values.items[i];
    const auto value = [&](std::size_t c) {
      return ConfigNode::of(values[i][c] + fraction * (values[i + 1][c] - values[i][c]));
    };
    if (between.kind != NodeKind::list) between = value(0);
    for (std::size_t c = 0; c < between.items.size(); ++c) between.items[c] = value(c);
    nodes.push_back(std::move(between));
  }
  return nodes;
}

}  // namespace

std::vector<std::string> indexed_path(const ConfigNode& config, const std::string& path) {
  std::vector<std::string> words = words_of_path(config, path);
  const ConfigNode* node = &config;
  for (std::string& word : words) {
    if (!node) break;
    if (node->kind == NodeKind::list) {
      const auto index = node->index_of(word);
      if (index) word = std::to_string(*index);
      node = index ? &node->items[*index] : nullptr;
    } else {
      node = node->find(word);
    }
  }
  return words;
}

void KeyParameters::declare(Declaration<KeyParameters>& d) {
  d.add("parameter", &KeyParameters::parameter)
      .required()
      .description(
          "path of the parameter, as for --set, in material, energies, contact, obstacles, friction, pins or "
          "handles; an index or a name selects an item of a list, as in energies.gravity.acceleration");
  d.add("times", &KeyParameters::times)
      .at_least(0)
      .at_most(1e9)
      .required()
      .description("pseudo-times, ascending; the scene begins at 0");
  d.add_node("values", &KeyParameters::values)
      .required()
      .description("one value per time, each a number or a list of numbers");
  d.add_choice("interpolation", &KeyParameters::interpolation,
               {{"linear", KeyInterpolation::linear},
                {"log", KeyInterpolation::log},
                {"step", KeyInterpolation::step}})
      .description("interpolation between two times; constant before the first and after the last");
}

void ScheduleParameters::declare(Declaration<ScheduleParameters>& d) {
  d.add("duration", &ScheduleParameters::duration)
      .at_least(0)
      .at_most(1e9)
      .description("total pseudo-time, in the unit of `times`; 0 takes the last time of all keys");
  d.add("steps", &ScheduleParameters::steps)
      .at_least(1)
      .at_most(1e6)
      .description("number of equal load increments")
      .source("supplement, section 4");
  d.add("equilibrate", &ScheduleParameters::equilibrate)
      .description(
          "solve for equilibrium after every increment; otherwise take one implicit step, and equilibrate "
          "only after the last increment");
  d.add_sections("keys", &ScheduleParameters::keys).description("parameters that change");
}

void set_first_keys(ConfigNode& source) {
  ConfigErrors ignored;  // check_schedule reports them
  const ConfigNode* schedule = source.find("schedule");
  const ConfigNode* keys = schedule ? schedule->find("keys") : nullptr;
  if (!keys || keys->kind != NodeKind::list) return;
  for (const ConfigNode& key : std::vector<ConfigNode>(keys->items)) {
    const ConfigNode *parameter = key.find("parameter"), *values = key.find("values");
    if (!parameter || !values || values->kind != NodeKind::list || values->items.empty()) continue;
    const std::string& path = parameter->scalar;
    if (std::find(changeable.begin(), changeable.end(), path.substr(0, path.find('.'))) != changeable.end())
      set_parameter(source, path, values->items[0], parameter->where, ignored);
  }
}

void check_schedule(const Experiment& e, ConfigErrors& errors) {
  const ScheduleParameters& p = e.parameters.schedule;
  for (std::size_t k = 0; k < p.keys.size(); ++k) {
    const KeyParameters& key = p.keys[k];
    const Location where = e.source.find("schedule")->find("keys")->items[k].where;
    const std::string name = "key \"" + excerpt(key.parameter) + "\"";
    const auto refuse = [&](const std::string& what) { errors.push_back({where, name + " " + what}); };
    if (key.parameter.empty()) continue;  // the schema has reported it
    if (std::find(changeable.begin(), changeable.end(), key.parameter.substr(0, key.parameter.find('.'))) ==
        changeable.end())
      refuse("cannot change while a level is solved; keys are for parameters of " + joined(changeable));
    else if (!std::is_sorted(key.times.begin(), key.times.end(), std::less_equal<>()))
      refuse("must have ascending \"times\"");
    else if (values_of(key).empty())
      refuse("must have as many \"values\" as \"times\", all numbers or all lists of " +
             std::string("equally many numbers, as in {times: [0, 1], values: [[0, 0, 0], [0, 0, 0.1]]}"));
    else if (key.interpolation == KeyInterpolation::log)
      for (const auto& value : values_of(key))
        if (*std::min_element(value.begin(), value.end()) <= 0) {
          refuse("is interpolated by its logarithm: all its values must be above 0");
          break;
        }
  }
  if (errors.empty()) refuse_repeated_keys(e, errors);
  if (errors.empty()) refuse_keys_of_following_pins(e, errors);
  if (!errors.empty() || p.keys.empty()) return;
  static const Schema schema = schema_of<ExperimentParameters>();
  // Every keyed value, and one between each two, as its parameter would take it from the file.
  for (std::size_t k = 0; k < p.keys.size(); ++k)
    for (const ConfigNode& value : with_values_between(p.keys[k])) {
      ConfigNode config = e.resolved;
      ConfigErrors own;
      const Location where = e.source.find("schedule")->find("keys")->items[k].find("values")->where;
      if (set_parameter(config, p.keys[k].parameter, value, where, own)) {
        ExperimentParameters read;
        schema.read(&read, config, own);
        check_plugins(e, read, own);
      }
      for (const ConfigError& error : own)
        errors.push_back({where, "key \"" + excerpt(p.keys[k].parameter) + "\": " + error.message});
      if (!own.empty()) break;
    }
}

KeyedValues::KeyedValues(const ScheduleParameters& schedule)
    : keys_(schedule.keys), duration_(duration_of(schedule)), steps_(schedule.steps) {
  for (const KeyParameters& key : keys_) values_.push_back(values_of(key));
}

std::vector<double> KeyedValues::at(double time) const {
  std::vector<double> all;
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const std::vector<double> own = value_at(keys_[k], values_[k], time);
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

std::vector<double> KeyedValues::first() const {
  std::vector<double> all;
  for (const auto& values : values_) all.insert(all.end(), values[0].begin(), values[0].end());
  return all;
}

ConfigNode KeyedValues::node(std::size_t k, const double* values) const {
  if (keys_[k].values.items[0].kind != NodeKind::list) return ConfigNode::of(*values);
  ConfigNode list;
  list.kind = NodeKind::list;
  for (std::size_t c = 0; c < count(k); ++c) list.items.push_back(ConfigNode::of(values[c]));
  return list;
}

}  // namespace drape
