#include <algorithm>
#include <cmath>
#include <map>

#include "core/app/experiment/experiment_path.h"
#include "core/app/experiment/load.h"
#include "core/app/experiment/read_experiment.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/parameters.h"

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
    if (!item.is_number() || !std::isfinite(item.number)) return {};
    numbers.push_back(item.number);
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

/// The numbers of a resolved experiment that a key sets; empty if it names anything else.
std::vector<const ConfigNode*> numbers_at(const ConfigNode& resolved, const ScheduleKey& key) {
  const ConfigNode* node = value_at(resolved, key.parameter);
  std::vector<const ConfigNode*> numbers;
  if (node && node->kind == NodeKind::number) numbers.push_back(node);
  for (std::size_t c = 0; node && c < node->items.size(); ++c)
    if (node->items[c].kind == NodeKind::number) numbers.push_back(&node->items[c]);
  return numbers;
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
    for (ScheduleKey& key : keys_) find_section(key);
    if (!errors_.empty()) return;
    std::size_t times = 0;  // at which every level is checked
    for (const ScheduleKey& key : keys_)
      if (!key.is_of_contact()) times += key.times.size();
    if (times > most_times)
      return refuse_many("times in the keys of material, energies, pins and handles", times, most_times);
    refuse_repeated_keys();
    if (errors_.empty()) refuse_keys_of_following_pins();
    if (!errors_.empty()) return;
    check_values();
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
    if (!is_changeable(key.parameter))
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

  void find_section(ScheduleKey& key) {
    const std::vector<std::string> words = words_of_path(e_.resolved, key.parameter);
    key.section = words[0];
    if (words.size() > 1) key.item = e_.resolved.find(words[0])->index_of(words[1]).value_or(0);
    if (numbers_at(e_.resolved, key).size() != key.values[0].size()) refuse_parameter(key);
  }

  /// Why the path of a key leads nowhere: as of an option --set, or that it names no number.
  void refuse_parameter(const ScheduleKey& key) {
    const Location& where = key.written.where;
    ConfigNode config = e_.resolved;
    ConfigErrors own;
    if (set_parameter(config, key.parameter, key.written.items[0], where, own))
      own.push_back({where,
                     "it must name a number that is no integer, or a list of as many such numbers as each of "
                     "its values"});
    errors_.push_back({where, name(key) + ": " + own[0].message});
  }

  /// Two keys may not set one number.
  void refuse_repeated_keys() {
    std::map<const ConfigNode*, const ScheduleKey*> keys_of;
    for (const ScheduleKey& key : keys_)
      for (const ConfigNode* number : numbers_at(e_.resolved, key))
        if (const auto [other, is_new] = keys_of.try_emplace(number, &key); !is_new) {
          refuse(key, "sets what key \"" + excerpt(other->second->parameter) + "\" sets; remove one of them");
          break;
        }
  }

  /// The obstacle that a pin follows decides its targets.
  void refuse_keys_of_following_pins() {
    for (const ScheduleKey& key : keys_) {
      if (key.section != "pins") continue;
      const std::string& obstacle = e_.parameters.pins[key.item].follow.obstacle;
      if (!obstacle.empty())
        refuse(key, "changes pin " + std::to_string(key.item) + ", which follows obstacle \"" +
                        excerpt(obstacle) + "\"; move the obstacle, or remove \"follow\"");
    }
  }

  /// Appends the faults of the first value of each key that a part of the experiment refuses.
  void check_values() {
    const Load first{e_.parameters.schedule.values_at(0), nullptr, e_.energies, e_.contacts};
    constexpr std::size_t most_checked =
        300'000;  // obstacles × values; the run finds the faults of later ones
    std::size_t begin = 0, checked = 0;
    for (const ScheduleKey& key : keys_) {
      ConfigErrors own;
      for (std::size_t i = 0; i < key.values.size() && own.empty() && checked < most_checked; ++i) {
        checked += e_.parameters.obstacles.size();
        Load load = first;
        std::vector<double> values = first.values;
        std::ranges::copy(key.values[i], values.begin() + static_cast<std::ptrdiff_t>(begin));
        set_values(e_, load_values(keys_, values, first.values), load, own);
      }
      for (const ConfigError& error : own)
        errors_.push_back({key.written.where, name(key) + ": " + error.message});
      begin += key.values[0].size();
    }
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

}  // namespace drape
