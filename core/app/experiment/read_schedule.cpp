#include <algorithm>
#include <cmath>
#include <set>

#include "core/app/experiment/experiment_path.h"
#include "core/app/experiment/read_experiment.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/parameters.h"
#include "core/kernel/plugin/registry.h"

namespace drape {

namespace {

using NodeKind = ConfigNode::Kind;

/// Sections whose parameters may change; the others choose the discretisation and the methods.
const std::vector<std::string> changeable = {"material", "energies", "contact", "obstacles",
                                             "friction", "pins",     "handles"};

bool is_changeable(const std::string& path) { return is_one_of(path.substr(0, path.find('.')), changeable); }

/// A number or a list of them; empty for anything else.
std::vector<double> numbers_of(const ConfigNode& node) {
  std::vector<double> numbers;
  for (const ConfigNode& item : node.kind == NodeKind::list ? node.items : std::vector{node}) {
    const std::optional<double> number = number_of(item.scalar);
    if (!number) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

/// The values of a key at each of its times; empty unless all are numbers, or lists of equally many.
std::vector<std::vector<double>> values_of(const ScheduleKey& key) {
  if (key.written.kind != NodeKind::list || key.written.items.size() != key.times.size()) return {};
  std::vector<std::vector<double>> values;
  for (const ConfigNode& item : key.written.items) {
    values.push_back(numbers_of(item));
    if (values.back().empty() || values.back().size() != values[0].size() ||
        item.items.empty() != key.written.items[0].items.empty())
      return {};
  }
  return values;
}

class KeyReader {
 public:
  KeyReader(Experiment& experiment, ConfigErrors& errors)
      : e_(experiment), keys_(experiment.parameters.schedule.keys), errors_(errors) {}

  void read_all() {
    constexpr std::size_t most_keys = 200, most_times = 1000;
    if (keys_.size() > most_keys) return refuse_many("keys", keys_.size(), most_keys);
    for (ScheduleKey& key : keys_) read_values(key);
    if (!errors_.empty()) return;
    for (ScheduleKey& key : keys_) find_targets(key);
    if (!errors_.empty()) return;
    std::size_t times = 0;  // at which every level is checked
    for (const ScheduleKey& key : keys_)
      if (key.targets[0].part != LoadPart::contact) times += key.times.size();
    if (times > most_times)
      return refuse_many("times in the keys of material, energies, pins and handles", times, most_times);
    refuse_repeated_keys();
    if (errors_.empty()) refuse_keys_of_following_pins();
    if (!errors_.empty()) return;
    for (const ScheduleKey& key : keys_) check_values(key);
  }

 private:
  static std::string name(const ScheduleKey& key) { return "key \"" + excerpt(key.parameter) + "\""; }
  void refuse(const ScheduleKey& key, const std::string& what) {
    const ConfigNode& keys = *e_.source.find("schedule")->find("keys");
    errors_.push_back({keys.items[&key - keys_.data()].where, name(key) + " " + what});
  }

  void refuse_many(const std::string& what, std::size_t count, std::size_t most) {
    errors_.push_back(
        {e_.source.find("schedule")->where_of("keys"),
         "\"schedule\" has " + std::to_string(count) + " " + what + ", of at most " + std::to_string(most)});
  }

  void read_values(ScheduleKey& key) {
    if (key.parameter.empty()) return;  // the schema has reported it
    key.values = values_of(key);
    const auto not_positive = [](const std::vector<double>& value) { return std::ranges::min(value) <= 0; };
    if (!is_changeable(key.parameter) && !e_.parameters.dress.is_asked())  // whose keys drape makes itself
      refuse(key, "cannot change while a level is solved; keys are for parameters of " + joined(changeable));
    else if (!std::is_sorted(key.times.begin(), key.times.end(), std::less_equal<>()))
      refuse(key, "must have ascending \"times\"");
    else if (key.values.empty())
      refuse(
          key,
          "must have as many \"values\" as \"times\", all numbers or all lists of equally many numbers, as "
          "in {times: [0, 1], values: [[0, 0, 0], [0, 0, 0.1]]}");
    else if (key.interpolation == KeyInterpolation::log && std::ranges::any_of(key.values, not_positive))
      refuse(key, "is interpolated by its logarithm: all its values must be above 0");
  }

  /// Adds a target of the key, if the words name numbers of the part's struct.
  void add_target(ScheduleKey& key, LoadPart part, std::size_t item, const std::vector<std::string>& words) {
    const PluginParameters own = parameters_of(e_, part, item);
    const auto numbers =
        DeclaredNumbers::find(own.entry ? own.entry->schema : scheduled_schema(), own.values.get(), words);
    if (numbers && numbers->count() == key.values[0].size()) key.targets.push_back({part, item, *numbers});
  }

  void find_targets(ScheduleKey& key) {
    const std::vector<std::string> words = words_of_path(e_.resolved, key.parameter);
    const std::string& part = words[0];
    const ConfigNode* section = e_.resolved.find(part);
    const bool is_list = section->kind == NodeKind::list;
    const auto item = is_list && words.size() > 1 ? section->index_of(words[1]) : std::nullopt;
    if (part == "friction") {
      for (std::size_t c = 0; c < e_.contact_configs.size(); ++c)
        add_target(key, LoadPart::contact, c, words);
    } else if (part == "obstacles" && item) {
      for (std::size_t c = 0; c < e_.contact_configs.size(); ++c) {
        const std::vector<std::size_t>& own = e_.contact_configs[c].obstacles;
        const auto place = std::ranges::find(own, *item);
        if (place == own.end()) continue;
        std::vector<std::string> path = words;
        path[1] = std::to_string(place - own.begin());
        add_target(key, LoadPart::contact, c, path);
      }
    } else if ((part == "energies" || part == "contact") && (item || !is_list)) {
      const std::vector<std::string> within(words.begin() + (item ? 2 : 1), words.end());
      add_target(key, part == "contact" ? LoadPart::contact : LoadPart::energies, item.value_or(0), within);
    } else if (part == "material" || part == "dress") {
      add_target(key, part == "dress" ? LoadPart::dress : LoadPart::material, 0, words);
    } else if (item) {
      add_target(key, part == "pins" ? LoadPart::pins : LoadPart::handles, *item, words);
    }
    if (key.targets.empty()) refuse_parameter(key);
  }

  /// Why the path of a key leads nowhere: as of an option --set, or that it names no number.
  void refuse_parameter(const ScheduleKey& key) {
    const Location& where = key.written.where;
    ConfigNode config = e_.resolved;
    ConfigErrors own;
    if (key.parameter == "friction")
      own.push_back({where, refusal_of_friction(*e_.registry)});
    else if (set_parameter(config, key.parameter, key.written.items[0], where, own))
      own.push_back({where,
                     "it must name a number that is no integer, or a list of as many such numbers as each of "
                     "its values"});
    errors_.push_back({where, name(key) + ": " + own[0].message});
  }

  /// Two keys may not set one number.
  void refuse_repeated_keys() {
    std::vector<std::set<const double*>> numbers(keys_.size());
    for (std::size_t k = 0; k < keys_.size(); ++k) {
      for (const KeyTarget& target : keys_[k].targets)
        for (std::size_t c = 0; c < target.numbers.count(); ++c)
          numbers[k].insert(target.numbers.at(parameters_of(e_, target.part, target.item).values.get(), c));
      for (std::size_t j = 0; j < k; ++j)
        if (std::ranges::any_of(numbers[k], [&](const double* own) { return numbers[j].contains(own); }))
          refuse(keys_[k], "sets what key \"" + excerpt(keys_[j].parameter) + "\" sets; remove one of them");
    }
  }

  /// The obstacle that a pin follows decides its targets.
  void refuse_keys_of_following_pins() {
    for (const ScheduleKey& key : keys_) {
      const KeyTarget& target = key.targets[0];
      if (target.part != LoadPart::pins) continue;
      const std::string& obstacle = e_.parameters.pins[target.item].follow.obstacle;
      if (!obstacle.empty())
        refuse(key, "changes pin " + std::to_string(target.item) + ", which follows obstacle \"" +
                        excerpt(obstacle) + "\"; move the obstacle, or remove \"follow\"");
    }
  }

  /// Appends the faults of the first value of a key that a part of the experiment refuses.
  void check_values(const ScheduleKey& key) {
    const Location& where = key.written.where;
    for (const std::vector<double>& value : key.values) {
      ConfigErrors own;
      for (const KeyTarget& target : key.targets)
        if (own.empty()) check_value(target, value, own);
      for (const ConfigError& error : own) errors_.push_back({where, name(key) + ": " + error.message});
      if (!own.empty()) return;
    }
  }

  void check_value(const KeyTarget& target, const std::vector<double>& value, ConfigErrors& own) {
    PluginParameters changed = parameters_of(e_, target.part, target.item);
    const Schema& schema = changed.entry ? changed.entry->schema : scheduled_schema();
    changed.values = schema.copy(changed.values.get());
    target.numbers.set(changed.values.get(), value.data(), own);
    if (!own.empty() || !changed.entry) return;
    const bool energy = target.part == LoadPart::energies;
    make_plugin(
        changed, [](const auto&, const auto&) { return Location(); }, own,
        energy ? static_cast<const void*>(e_.energies[target.item].energy.get())
               : e_.contacts[target.item].get());
  }

  Experiment& e_;
  std::vector<ScheduleKey>& keys_;
  ConfigErrors& errors_;
};

}  // namespace

void ScheduleKey::declare(Declaration<ScheduleKey>& d) {
  d.add("parameter", &ScheduleKey::parameter,
        "path of the parameter, a number or a list of numbers, as for --set, in material, energies, contact, "
        "obstacles, friction, pins or handles; an index or a name selects an item of a list, as in "
        "energies.gravity.acceleration. Integers cannot change")
      .required();
  d.add("times", &ScheduleKey::times, "pseudo-times, ascending; the scene begins at 0")
      .between(0, 1e9)
      .required();
  d.add("values", &ScheduleKey::written, "one value per time, each a number or a list of numbers").required();
  d.add_choice("interpolation", &ScheduleKey::interpolation,
               {{"linear", KeyInterpolation::linear},
                {"log", KeyInterpolation::log},
                {"step", KeyInterpolation::step}},
               "interpolation between two times; constant before the first and after the last");
}

void ScheduleParameters::declare(Declaration<ScheduleParameters>& d) {
  d.add(
       "duration", &ScheduleParameters::duration,
       "total pseudo-time, in the unit of `times`, beyond which keys are not followed; 0 takes the last time "
       "of all keys")
      .between(0, 1e9);
  d.add("steps", &ScheduleParameters::steps, "number of equal load increments")
      .between(1, 1e6)
      .source("supplement, section 4");
  d.add("equilibrate", &ScheduleParameters::equilibrate,
        "solve for equilibrium after every increment; otherwise take one implicit step, and equilibrate only "
        "after the last increment");
  d.add_sections("keys", &ScheduleParameters::keys,
                 "parameters that change, at most 200; those of material, energies, pins and handles have at "
                 "most 1000 times in all");
}

std::vector<double> ScheduleKey::at(double time) const {
  const auto next = std::upper_bound(times.begin(), times.end(), time);
  if (next == times.begin()) return values.front();
  const auto i = static_cast<std::size_t>(next - times.begin()) - 1;
  if (next == times.end() || interpolation == KeyInterpolation::step) return values[i];
  const double part = (time - times[i]) / (times[i + 1] - times[i]);
  std::vector<double> value = values[i];
  for (std::size_t c = 0; c < value.size(); ++c)
    value[c] = interpolation == KeyInterpolation::log ? value[c] * std::pow(values[i + 1][c] / value[c], part)
                                                      : value[c] + part * (values[i + 1][c] - value[c]);
  return value;
}

double ScheduleParameters::time(int increment) const {
  double whole = duration;
  for (const ScheduleKey& key : keys)
    if (duration == 0 && !key.times.empty()) whole = std::max(whole, key.times.back());
  const double time = whole * increment / steps;
  // Rounded, it may be just before a key's time, and a step there would come an increment late or never.
  for (const ScheduleKey& key : keys)
    for (const double own : key.times)
      if (std::abs(time - own) <= 1e-12 * whole) return own;
  return time;
}

std::vector<double> ScheduleParameters::values_at(double time) const {
  std::vector<double> all;
  for (const ScheduleKey& key : keys) {
    const std::vector<double> own = key.at(time);
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

void set_first_keys(ConfigNode& source) {
  ConfigErrors ignored;  // read_keys reports them
  const ConfigNode* schedule = source.find("schedule");
  const ConfigNode* keys = schedule ? schedule->find("keys") : nullptr;
  if (!keys || keys->kind != NodeKind::list) return;
  for (const ConfigNode& key : std::vector<ConfigNode>(keys->items)) {
    const ConfigNode *parameter = key.find("parameter"), *values = key.find("values");
    if (!parameter || !values || values->kind != NodeKind::list || values->items.empty()) continue;
    if (is_changeable(parameter->scalar))
      set_parameter(source, parameter->scalar, values->items[0], parameter->where, ignored);
  }
}

void read_keys(Experiment& experiment, ConfigErrors& errors) { KeyReader(experiment, errors).read_all(); }

PluginParameters parameters_of(const Experiment& e, LoadPart part, std::size_t item) {
  if (part == LoadPart::energies) return e.energy_parameters.at(item);
  if (part == LoadPart::contact) return e.contact_configs.at(item).parameters;
  return {nullptr, {std::shared_ptr<void>(), const_cast<ExperimentParameters*>(&e.parameters)}};
}

}  // namespace drape
