#include "core/experiment/schedule.h"

#include <algorithm>
#include <cmath>

#include "core/experiment/places.h"
#include "core/experiment/yaml_file.h"
#include "core/mesh/message_text.h"
#include "core/model/stretch_limit.h"
#include "core/plugin/make.h"
#include "core/plugin/string_utils.h"

namespace drape {

namespace {

using NodeKind = ConfigNode::Kind;

/// Sections that conditions are; the others say what is computed, and how.
const std::vector<std::string> changeable = {"material", "energies", "contact", "pins", "handles"};
/// A change is tried at most so often, in ever smaller parts, before it is left for later.
constexpr int most_tries = 30;
constexpr double smallest_part = 1e-6;

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

/// What a key's `to` says at each of its times; empty where that is not so many numbers each.
std::vector<std::vector<double>> values_of(const KeyParameters& key) {
  if (key.to.kind != NodeKind::list || key.to.items.size() != key.at.size()) return {};
  std::vector<std::vector<double>> values;
  for (const ConfigNode& item : key.to.items) {
    values.push_back(numbers_of(item));
    if (values.back().empty() || values.back().size() != values[0].size()) return {};
  }
  return values;
}

std::vector<double> value_at(const KeyParameters& key, const std::vector<std::vector<double>>& values,
                             double time) {
  const auto next = std::upper_bound(key.at.begin(), key.at.end(), time);
  if (next == key.at.begin()) return values.front();
  const auto i = static_cast<std::size_t>(next - key.at.begin()) - 1;
  if (next == key.at.end() || key.between == Between::jump) return values[i];
  const double part = (time - key.at[i]) / (key.at[i + 1] - key.at[i]);
  std::vector<double> value = values[i];
  for (std::size_t c = 0; c < value.size(); ++c)
    value[c] = key.between == Between::log ? value[c] * std::pow(values[i + 1][c] / value[c], part)
                                           : value[c] + part * (values[i + 1][c] - value[c]);
  return value;
}

ConfigNode node_of(const KeyParameters& key, const double* numbers) {
  const ConfigNode& shape = key.to.items[0];
  if (shape.kind != NodeKind::list) return ConfigNode::of(*numbers);
  ConfigNode list;
  list.kind = NodeKind::list;
  for (std::size_t c = 0; c < shape.items.size(); ++c) list.items.push_back(ConfigNode::of(numbers[c]));
  return list;
}

double duration_of(const ScheduleParameters& p) {
  double duration = p.duration;
  for (const KeyParameters& key : p.keys)
    if (p.duration == 0 && !key.at.empty()) duration = std::max(duration, key.at.back());
  return duration;
}

/// The way of the obstacles from one model to the other with the cloth at x.
StepLimit obstacles_way(const LevelModel& from, const LevelModel& to, const Positions& x) {
  StepLimit limit;
  for (std::size_t k = 0; k < to.contacts().size(); ++k) {
    if (to.contacts()[k] == from.contacts()[k]) continue;
    if (const auto* movable = dynamic_cast<const MovableObstacles*>(to.contacts()[k].get())) {
      StepLimit own = movable->max_move(*from.contacts()[k], x);
      if (own.fraction < limit.fraction) limit = std::move(own);
    }
  }
  return limit;
}

}  // namespace

void KeyParameters::declare(Declaration<KeyParameters>& d) {
  d.add("set", &KeyParameters::set)
      .required()
      .description(
          "path of the parameter, as for --set: in material, energies, contact, pins or handles; a plugin "
          "of a list by its place or its name, as in energies.gravity.acceleration");
  d.add("at", &KeyParameters::at).at_least(-1e9).at_most(1e9).required().description("pseudo-times, rising");
  d.add_node("to", &KeyParameters::to)
      .required()
      .description("a list of as many values, numbers or lists of them");
  d.add_choice("between", &KeyParameters::between,
               {{"linear", Between::linear}, {"log", Between::log}, {"jump", Between::jump}})
      .description("from one time to the next; before the first and after the last the value stays");
}

void ScheduleParameters::declare(Declaration<ScheduleParameters>& d) {
  d.add("duration", &ScheduleParameters::duration)
      .at_least(0)
      .at_most(1e9)
      .description("pseudo-time in all, in the unit of the keys; 0 goes to the last of them");
  d.add("steps", &ScheduleParameters::steps)
      .at_least(1)
      .at_most(1e6)
      .description("changes of the conditions in that time, evenly spaced")
      .source("supplement, section 4");
  d.add("settle", &ScheduleParameters::settle)
      .description("to equilibrium after every change; if not, one implicit step. After the last always");
  d.add_sections("keys", &ScheduleParameters::keys).description("what changes");
}

void set_first_keys(ConfigNode& source) {
  ConfigErrors said_later;
  const ConfigNode* schedule = source.find("schedule");
  const ConfigNode* keys = schedule ? schedule->find("keys") : nullptr;
  if (!keys || keys->kind != NodeKind::list) return;
  for (const ConfigNode& key : std::vector<ConfigNode>(keys->items)) {
    const ConfigNode *set = key.find("set"), *to = key.find("to");
    if (!set || !to || to->kind != NodeKind::list || to->items.empty()) continue;
    const std::string& path = set->scalar;
    if (std::find(changeable.begin(), changeable.end(), path.substr(0, path.find('.'))) != changeable.end())
      set_path(source, path, to->items[0], set->where, said_later);
  }
}

void check_schedule(const Experiment& e, ConfigErrors& errors) {
  const ScheduleParameters& p = e.parameters.schedule;
  for (std::size_t k = 0; k < p.keys.size(); ++k) {
    const KeyParameters& key = p.keys[k];
    const Location where = e.source.find("schedule")->find("keys")->items[k].where;
    const std::string name = "key \"" + excerpt(key.set) + "\"";
    const auto refuse = [&](const std::string& what) { errors.push_back({where, name + " " + what}); };
    if (std::find(changeable.begin(), changeable.end(), key.set.substr(0, key.set.find('.'))) ==
        changeable.end())
      refuse("cannot change while a level is solved; keys are for parameters of " + joined(changeable));
    else if (!std::is_sorted(key.at.begin(), key.at.end(), std::less_equal<>()))
      refuse("must have times \"at\" that rise");
    else if (values_of(key).empty())
      refuse("must have as many values under \"to\" as times under \"at\", all numbers or all lists of " +
             std::string("as many numbers, as in {at: [0, 1], to: [[0, 0, 0], [0, 0, 0.1]]}"));
    else if (key.between == Between::log)
      for (const auto& value : values_of(key))
        if (*std::min_element(value.begin(), value.end()) <= 0) {
          refuse("goes by its logarithm, so that all its values must be above 0");
          break;
        }
  }
  if (!errors.empty() || p.keys.empty()) return;
  static const Schema schema = schema_of<ExperimentParameters>();
  // Every keyed value, as its parameter would take it from the file.
  for (std::size_t k = 0; k < p.keys.size(); ++k)
    for (const ConfigNode& value : p.keys[k].to.items) {
      ConfigNode config = e.resolved;
      ConfigErrors own;
      const Location where = e.source.find("schedule")->find("keys")->items[k].find("to")->where;
      if (set_path(config, p.keys[k].set, value, where, own)) {
        ExperimentParameters read;
        schema.read(&read, config, own);
        for (const ConfigNode& node : read.energies) make_from<Energy>(*e.registry, node, own);
        if (read.contact.kind == NodeKind::list)
          for (const ConfigNode& node : read.contact.items) make_from<ContactModel>(*e.registry, node, own);
        else
          make_from<ContactModel>(*e.registry, read.contact, own);
      }
      for (const ConfigError& error : own)
        errors.push_back({where, "key \"" + excerpt(p.keys[k].set) + "\": " + error.message});
      if (!own.empty()) break;
    }
}

Schedule::Schedule(Experiment experiment, Scene& scene)
    : experiment_(std::move(experiment)),
      scene_(scene),
      p_(experiment_.parameters.schedule),
      duration_(duration_of(p_)) {
  for (const KeyParameters& key : p_.keys) values_.push_back(values_of(key));
  effective_ = wanted(0);
  now_.energies = scene.energies;
  now_.contacts = experiment_.contacts;
  now_.parameters = moment(effective_, made_from_).parameters;
}

std::vector<double> Schedule::wanted(int change) const {
  std::vector<double> all;
  for (std::size_t k = 0; k < p_.keys.size(); ++k) {
    const std::vector<double> own = value_at(p_.keys[k], values_[k], duration_ * change / p_.steps);
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

Moment Schedule::moment(const std::vector<double>& numbers, std::vector<std::string>& made_from) const {
  ConfigNode config = experiment_.resolved;
  ConfigErrors errors;
  const double* at = numbers.data();
  for (std::size_t k = 0; k < p_.keys.size(); ++k) {
    set_path(config, p_.keys[k].set, node_of(p_.keys[k], at), Location(), errors);
    at += values_[k][0].size();
  }
  Moment m;
  static const Schema schema = schema_of<ExperimentParameters>();
  schema.read(&m.parameters, config, errors);
  made_from.clear();
  const auto same = [&](const ConfigNode& node) {
    made_from.push_back(node.one_line());
    const std::size_t k = made_from.size() - 1;
    return k < made_from_.size() && made_from_[k] == made_from[k];
  };
  const Registry& registry = *experiment_.registry;
  for (const ConfigNode& node : m.parameters.energies) {
    const std::size_t k = m.energies.size();
    m.energies.push_back({experiment_.energies[k].name,
                          same(node) ? now_.energies[k].energy : make_from<Energy>(registry, node, errors)});
  }
  if (!m.parameters.handles.empty()) {
    const std::size_t k = m.energies.size();
    const bool kept = same(*config.find("handles"));
    m.energies.push_back({"handles", kept ? now_.energies[k].energy
                                          : handles_energy(m.parameters, scene_.hierarchy.levels[0])});
  }
  const ConfigNode& contact = m.parameters.contact;
  for (const ConfigNode& node : contact.kind == NodeKind::list ? contact.items : std::vector{contact})
    m.contacts.push_back(same(node) ? now_.contacts[m.contacts.size()]
                                    : make_from<ContactModel>(registry, node, errors));
  if (!errors.empty())
    throw std::runtime_error("the schedule at pseudo-time " + std::to_string(time()) + ": " +
                             errors[0].message);
  return m;
}

LevelModel Schedule::model_under(const Moment& m, int level) const {
  const Level &own = scene_.hierarchy.levels[level], &coarsest = scene_.hierarchy.levels[0];
  return {own,        m.parameters.material,
          m.energies, held_vertices(m.parameters, own, coarsest, scene_.starts[level]),
          m.contacts, scene_.models[level].get()};
}

void Schedule::go_to(Moment moment, std::vector<std::string> made_from, std::vector<double> numbers) {
  now_ = std::move(moment);
  made_from_ = std::move(made_from);
  effective_ = std::move(numbers);
}

void Schedule::begin(int level, bool from_start) {
  if (from_start)
    restore(level, {0, wanted(0)});
  else
    bind_from(level);
}

void Schedule::restore(int level, const ConditionsState& state) {
  change_ = state.change;
  std::vector<std::string> made_from;
  Moment then = moment(state.numbers, made_from);
  go_to(std::move(then), std::move(made_from), state.numbers);
  bind_from(level);
}

void Schedule::bind_from(int level) {
  for (std::size_t l = level; l < scene_.models.size(); ++l)
    *scene_.models[l] = model_under(now_, static_cast<int>(l));
}

StepLimit Schedule::advance(int level, const Positions& x) {
  if (made()) ++change_;
  StepLimit limit;
  double part = 1;
  for (int tries = 0; tries < most_tries && part >= smallest_part; ++tries) {
    StepLimit allowed = make_part(part, level, x);
    if (allowed.fraction == 1) {
      limit.fraction = part;
      return limit;
    }
    limit.by = std::move(allowed.by);
    part *= allowed.fraction;
  }
  limit.fraction = 0;
  return limit;
}

bool Schedule::advance_by(double part, int level, const Positions& x) {
  return make_part(part, level, x).fraction == 1;
}

StepLimit Schedule::make_part(double part, int level, const Positions& x) {
  std::vector<double> numbers = wanted(change_);
  if (part < 1)
    for (std::size_t c = 0; c < numbers.size(); ++c)
      numbers[c] = effective_[c] + part * (numbers[c] - effective_[c]);
  std::vector<std::string> made_from;
  Moment next = moment(numbers, made_from);
  LevelModel model = model_under(next, level);
  if (std::string refused = beyond_limits(model.limits(), x, 1); !refused.empty())
    return {0.5, std::move(refused)};
  if (StepLimit way = obstacles_way(*scene_.models[level], model, x); way.fraction < 1) return way;
  *scene_.models[level] = std::move(model);
  change_energies_above(level, next);
  go_to(std::move(next), std::move(made_from), std::move(numbers));
  return {};
}

void Schedule::change_energies_above(int level, const Moment& next) {
  bool same = next.parameters.material == now_.parameters.material;
  for (std::size_t k = 0; k < next.energies.size(); ++k)
    same = same && next.energies[k].energy == now_.energies[k].energy;
  if (same) return;
  for (std::size_t l = level + 1; l < scene_.models.size(); ++l) {
    LevelModel& model = *scene_.models[l];
    LevelModel changed(model.level(), next.parameters.material, next.energies, model.held(), {}, &model);
    changed.take_contacts(model);
    model = std::move(changed);
  }
}

}  // namespace drape
