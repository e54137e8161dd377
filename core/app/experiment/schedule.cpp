#include "core/app/experiment/schedule.h"

#include <algorithm>
#include <cmath>

#include "core/app/experiment/boundary_conditions.h"
#include "core/app/files/yaml_file.h"
#include "core/kernel/mesh/message_text.h"
#include "core/kernel/model/stretch_limit.h"
#include "core/kernel/plugin/make.h"
#include "core/kernel/plugin/string_utils.h"

namespace drape {

namespace {

using NodeKind = ConfigNode::Kind;

/// Sections whose parameters may change; the others choose the discretisation and the methods.
const std::vector<std::string> changeable = {"material", "energies", "contact", "pins", "handles"};
/// An increment is tried at most this often, in ever smaller fractions, before it waits for equilibrium.
constexpr int max_tries = 30;
constexpr double min_fraction = 1e-6;

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

ConfigNode node_of(const KeyParameters& key, const double* numbers) {
  const ConfigNode& shape = key.values.items[0];
  if (shape.kind != NodeKind::list) return ConfigNode::of(*numbers);
  ConfigNode list;
  list.kind = NodeKind::list;
  for (std::size_t c = 0; c < shape.items.size(); ++c) list.items.push_back(ConfigNode::of(numbers[c]));
  return list;
}

double duration_of(const ScheduleParameters& p) {
  double duration = p.duration;
  for (const KeyParameters& key : p.keys)
    if (p.duration == 0 && !key.times.empty()) duration = std::max(duration, key.times.back());
  return duration;
}

/// Largest feasible motion of the obstacles from one model to the other with the cloth at x.
StepLimit obstacle_step_limit(const LevelModel& from, const LevelModel& to, const Positions& x) {
  StepLimit limit;
  for (std::size_t k = 0; k < to.contacts().size(); ++k) {
    if (to.contacts()[k] == from.contacts()[k]) continue;
    if (const auto* kinematic = dynamic_cast<const KinematicObstacles*>(to.contacts()[k].get())) {
      StepLimit own = kinematic->max_step(*from.contacts()[k], x);
      if (own.fraction < limit.fraction) limit = std::move(own);
    }
  }
  return limit;
}

}  // namespace

void KeyParameters::declare(Declaration<KeyParameters>& d) {
  d.add("parameter", &KeyParameters::parameter)
      .formerly("set")
      .required()
      .description(
          "path of the parameter, as for --set, in material, energies, contact, pins or handles; an index or "
          "a name selects an item of a list, as in energies.gravity.acceleration");
  d.add("times", &KeyParameters::times)
      .formerly("at")
      .at_least(-1e9)
      .at_most(1e9)
      .required()
      .description("pseudo-times, ascending");
  d.add_node("values", &KeyParameters::values)
      .formerly("to")
      .required()
      .description("one value per time, each a number or a list of numbers");
  d.add_choice("interpolation", &KeyParameters::interpolation,
               {{"linear", KeyInterpolation::linear},
                {"log", KeyInterpolation::log},
                {"step", KeyInterpolation::step}})
      .formerly("between")
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
      .formerly("settle")
      .description(
          "solve for equilibrium after every increment; otherwise take one implicit step, and equilibrate "
          "only after the last increment");
  d.add_sections("keys", &ScheduleParameters::keys).description("parameters that change");
}

void set_first_keys(ConfigNode& source) {
  ConfigErrors said_later;
  const ConfigNode* schedule = source.find("schedule");
  const ConfigNode* keys = schedule ? schedule->find("keys") : nullptr;
  if (!keys || keys->kind != NodeKind::list) return;
  for (const ConfigNode& key : std::vector<ConfigNode>(keys->items)) {
    const ConfigNode *parameter = key.find("parameter"), *values = key.find("values");
    if (!parameter || !values || values->kind != NodeKind::list || values->items.empty()) continue;
    const std::string& path = parameter->scalar;
    if (std::find(changeable.begin(), changeable.end(), path.substr(0, path.find('.'))) != changeable.end())
      set_path(source, path, values->items[0], parameter->where, said_later);
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
  if (!errors.empty() || p.keys.empty()) return;
  static const Schema schema = schema_of<ExperimentParameters>();
  // Every keyed value, as its parameter would take it from the file.
  for (std::size_t k = 0; k < p.keys.size(); ++k)
    for (const ConfigNode& value : p.keys[k].values.items) {
      ConfigNode config = e.resolved;
      ConfigErrors own;
      const Location where = e.source.find("schedule")->find("keys")->items[k].find("values")->where;
      if (set_path(config, p.keys[k].parameter, value, where, own)) {
        ExperimentParameters read;
        schema.read(&read, config, own);
        for (const ConfigNode& node : read.energies) make_from<Energy>(*e.registry, node, own);
        if (read.contact.kind == NodeKind::list)
          for (const ConfigNode& node : read.contact.items) make_from<ContactModel>(*e.registry, node, own);
        else
          make_from<ContactModel>(*e.registry, read.contact, own);
      }
      for (const ConfigError& error : own)
        errors.push_back({where, "key \"" + excerpt(p.keys[k].parameter) + "\": " + error.message});
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
  now_.parameters = load_state(effective_, made_from_).parameters;
}

std::vector<double> Schedule::wanted(int increment) const {
  std::vector<double> all;
  for (std::size_t k = 0; k < p_.keys.size(); ++k) {
    const std::vector<double> own = value_at(p_.keys[k], values_[k], duration_ * increment / p_.steps);
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

LoadState Schedule::load_state(const std::vector<double>& numbers,
                               std::vector<std::string>& made_from) const {
  ConfigNode config = experiment_.resolved;
  ConfigErrors errors;
  const double* at = numbers.data();
  for (std::size_t k = 0; k < p_.keys.size(); ++k) {
    set_path(config, p_.keys[k].parameter, node_of(p_.keys[k], at), Location(), errors);
    at += values_[k][0].size();
  }
  LoadState m;
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

LevelModel Schedule::model_for(const LoadState& m, int level) const {
  const Level &own = scene_.hierarchy.levels[level], &coarsest = scene_.hierarchy.levels[0];
  return {own,        m.parameters.material,
          m.energies, dirichlet_vertices(m.parameters, own, coarsest, scene_.starts[level]),
          m.contacts, scene_.models[level].get()};
}

void Schedule::set_state(LoadState state, std::vector<std::string> made_from, std::vector<double> numbers) {
  now_ = std::move(state);
  made_from_ = std::move(made_from);
  effective_ = std::move(numbers);
}

void Schedule::begin(int level, bool from_start) {
  if (from_start)
    restore(level, {0, wanted(0)});
  else
    bind_from(level);
}

void Schedule::restore(int level, const LoadSteppingState& state) {
  increment_ = state.increment;
  std::vector<std::string> made_from;
  LoadState then = load_state(state.values, made_from);
  set_state(std::move(then), std::move(made_from), state.values);
  bind_from(level);
}

void Schedule::bind_from(int level) {
  for (std::size_t l = level; l < scene_.models.size(); ++l)
    *scene_.models[l] = model_for(now_, static_cast<int>(l));
}

StepLimit Schedule::advance(int level, const Positions& x) {
  if (complete()) ++increment_;
  StepLimit limit;
  double part = 1;
  for (int tries = 0; tries < max_tries && part >= min_fraction; ++tries) {
    StepLimit allowed = try_fraction(part, level, x);
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

bool Schedule::advance_by(double fraction, int level, const Positions& x) {
  return try_fraction(fraction, level, x).fraction == 1;
}

StepLimit Schedule::try_fraction(double fraction, int level, const Positions& x) {
  std::vector<double> numbers = wanted(increment_);
  if (fraction < 1)
    for (std::size_t c = 0; c < numbers.size(); ++c)
      numbers[c] = effective_[c] + fraction * (numbers[c] - effective_[c]);
  std::vector<std::string> made_from;
  LoadState next = load_state(numbers, made_from);
  LevelModel model = model_for(next, level);
  if (std::string refused = strain_limit_violations(model.limits(), x, 1); !refused.empty())
    return {0.5, std::move(refused)};
  if (StepLimit limit = obstacle_step_limit(*scene_.models[level], model, x); limit.fraction < 1)
    return limit;
  *scene_.models[level] = std::move(model);
  update_energies_above(level, next);
  set_state(std::move(next), std::move(made_from), std::move(numbers));
  return {};
}

void Schedule::update_energies_above(int level, const LoadState& next) {
  bool same = next.parameters.material == now_.parameters.material;
  for (std::size_t k = 0; k < next.energies.size(); ++k)
    same = same && next.energies[k].energy == now_.energies[k].energy;
  if (same) return;
  for (std::size_t l = level + 1; l < scene_.models.size(); ++l) {
    LevelModel& model = *scene_.models[l];
    LevelModel changed(model.level(), next.parameters.material, next.energies, model.dirichlet(), {}, &model);
    changed.take_contacts(model);
    model = std::move(changed);
  }
}

}  // namespace drape
