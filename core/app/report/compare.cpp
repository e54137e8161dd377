#include "core/app/report/compare.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "core/app/experiment/exit_codes.h"
#include "core/app/report/run_table.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"

namespace drape {

namespace {

using Names = std::vector<std::string>;

constexpr double time_noise = 0.10;      // smaller relative differences of times count as equal
constexpr double least_seconds = 0.05;   // smaller differences of times count as equal [s]
constexpr double relative_noise = 0.01;  // the same for all other quantities

/// What is compared of every level, beside the metrics.
const Names level_keys = {"seconds",         "iterations",    "flops",
                          "energy_released", "intersections", "smallest_gap"};

bool is_time(const std::string& key) { return key == "seconds" || key == "preview_seconds"; }
bool is_work(const std::string& key) { return key == "iterations" || key == "flops"; }

/// One quantity of one run.
struct Entry {
  std::string where;  ///< "pcs, level 2", with variation and seed if there are several
  std::string key;
  double value;
  Better better;
  const RunData* run;
};

/// All quantities in file order, and whether each method converged.
struct Side {
  std::vector<Entry> entries;
  std::map<std::string, bool> converged;

  const Entry* find(const Entry& other) const {
    for (const Entry& entry : entries)
      if (entry.where == other.where && entry.key == other.key) return &entry;
    return nullptr;
  }
};

void add_method(Side& side, const std::string& name, const RunData& run, const MethodRecord& method) {
  const auto add = [&](const std::string& where, const std::string& key, const OptionalNumber& value,
                       std::optional<Better> better = {}) {
    const bool higher = key == "smallest_gap" || key == "energy_released";
    if (value)
      side.entries.push_back(
          {where, key, *value, better.value_or(higher ? Better::higher : Better::lower), &run});
  };
  side.converged[name] = has_converged(method.status);
  const TableRow row = row_of(run, method);
  for (const std::string& key : summary_quantities(error_measures(run.metrics)))
    add(name, key, number_member(row, key));
  const bool several = method.levels.size() > 1;
  for (const LevelRecord& level : method.levels) {
    const std::string where = several ? name + ", level " + std::to_string(level.level) : name;
    for (const std::string& key : several ? level_keys : Names{"intersections", "smallest_gap"})
      add(where, key, number_member(level.values, key));
    for (const MetricColumn& column : columns_of(run.metrics, MetricScope::state, Shown::tables))
      add(where, column.name, number_member(level.values, column.name), column.better);
  }
  for (const ConsistencyRecord& pair : method.consistency)
    for (const MetricColumn& column : columns_of(run.metrics, MetricScope::pair, Shown::tables))
      add(name + ", levels " + std::to_string(pair.coarse) + " → " + std::to_string(pair.fine), column.name,
          number_member(pair.values, column.name), column.better);
}

Side side_of(const RunCollection& collection, bool named) {
  Side side;
  for (const RunRecord& run : collection.runs) {
    if (!run.data) continue;
    const std::string seed = run.seed ? ", seed " + std::to_string(std::llround(*run.seed)) : "";
    for (const MethodRecord& method : run.data->methods)
      add_method(side, (named ? run.variation + seed + ": " : "") + method.name, *run.data, method);
  }
  return side;
}

/// "faster", "slower", "less work", "more work", "better", "worse", "other", or "" for the same.
std::string verdict(const Entry& was, double after) {
  const std::string& key = was.key;
  const double difference = after - was.value, noise = is_time(key) ? time_noise : relative_noise;
  if (std::abs(difference) <= noise * std::min(std::abs(was.value), std::abs(after))) return "";
  if (is_time(key) && std::abs(difference) < least_seconds) return "";
  if (was.better == Better::neither) return "other";
  const bool good = (difference < 0) != (was.better == Better::higher);
  if (is_time(key)) return good ? "faster" : "slower";
  if (is_work(key)) return good ? "less work" : "more work";
  return good ? "better" : "worse";
}

/// What a cloth releases may be negative and counts zero: a ratio is relative to the absolute value.
bool holds(const Entry& was, double after, double ratio) {
  if (is_time(was.key) && after - was.value < least_seconds) return true;
  if (was.better == Better::higher && was.value >= 0) return after * ratio >= was.value;
  if (was.better == Better::higher) return after >= was.value * ratio;
  return after <= was.value + (ratio - 1) * std::abs(was.value);
}

std::map<std::string, double> parsed(const Names& bounds, const Names& known) {
  std::map<std::string, double> ratios;
  for (const std::string& text : bounds) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw std::runtime_error("--bound " + text + ": write it as KEY=RATIO, as in --bound seconds=1.1");
    const std::string key = text.substr(0, equals);
    if (!is_one_of(key, known))
      throw std::runtime_error("--bound " + excerpt(text) + ": there is no quantity \"" + excerpt(key) +
                               "\"; " + did_you_mean(key, known, "there are " + joined(known)));
    const std::optional<double> ratio = parse_number(text.substr(equals + 1));
    if (!ratio || !std::isfinite(*ratio) || *ratio <= 0)
      throw std::runtime_error("--bound " + text + ": the ratio must be a number above 0, as in --bound " +
                               key + "=1.1");
    ratios[key] = *ratio;
  }
  return ratios;
}

using Kind = ConfigNode::Kind;

/// The part of an experiment under model_keys, without the start's noise and the record of where a material's
/// numbers are from.
ConfigNode model_part(const ConfigNode& config) {
  ConfigNode model(Kind::map);
  for (const std::string& key : model_keys())
    if (const ConfigNode* part = config.find(key)) model.add(key, *part);
  if (ConfigNode* material = model.find("material")) material->remove("from_fabric");
  if (ConfigNode* start = model.find("start"))
    for (const char* noise : {"perturbation", "perturbation_wavelength", "seed"}) start->remove(noise);
  return model;
}

/// The word that names an item of a list in a path: its type or name, or its index.
std::string word_of(const ConfigNode& item, std::size_t index) {
  for (const char* key : {"type", "name"})
    if (const ConfigNode* word = item.find(key); word && !word->scalar.empty()) return word->scalar;
  return std::to_string(index);
}

void add_differences(const ConfigNode& a, const ConfigNode& b, const std::string& path, Names& differing) {
  const auto within = [&](const std::string& word) { return path.empty() ? word : path + "." + word; };
  const bool lists = a.kind == Kind::list && b.kind == Kind::list && a.items.size() == b.items.size();
  const auto is_map = [](const ConfigNode& item) { return item.kind == Kind::map; };
  if (lists && std::all_of(a.items.begin(), a.items.end(), is_map)) {
    for (std::size_t i = 0; i < a.items.size(); ++i)
      add_differences(a.items[i], b.items[i], within(word_of(a.items[i], i)), differing);
  } else if (is_map(a) && is_map(b)) {
    for (const auto& [key, value] : a.entries)
      if (const ConfigNode* other = b.find(key)) add_differences(value, *other, within(key), differing);
  } else if (a.one_line() != b.one_line()) {
    differing.push_back(path);
  }
}

}  // namespace

const Names& model_keys() {
  static const Names keys = {"cloth",    "levels",   "start",   "material", "pins",      "handles",
                             "schedule", "energies", "refiner", "contact",  "obstacles", "friction"};
  return keys;
}

std::string model_of(const ConfigNode& config) { return model_part(config).one_line(); }

Names differing_model_keys(const ConfigNode& a, const ConfigNode& b) {
  Names differing;
  add_differences(model_part(a), model_part(b), "", differing);
  return differing;
}

Comparison compare(const RunCollection& before, const RunCollection& after, const Names& bounds) {
  const bool named = before.runs.size() > 1 || after.runs.size() > 1;
  const Side a = side_of(before, named), b = side_of(after, named);
  Names known = level_keys, differing, broken;
  for (const Side* side : {&a, &b})
    for (const Entry& entry : side->entries) add_new(known, entry.key);
  const std::map<std::string, double> ratios = parsed(bounds, known);

  std::map<std::string, int> counts, met;
  std::vector<Names> rows = {{"where", "quantity", "before", "after", "change", "verdict"}};
  for (const Entry& was : a.entries) {
    const Entry* now = b.find(was);
    if (!now) continue;
    std::string word = verdict(was, now->value);
    if (was.key == "energy_released")  // has no better and worse where the models differ
      for (const std::string& key : differing_model_keys(was.run->config, now->run->config))
        add_new(differing, key), word = "other";
    ++counts[word];
    const auto bound = ratios.find(was.key);
    const bool breaks = bound != ratios.end() && !holds(was, now->value, bound->second);
    met[was.key] += bound != ratios.end();
    const std::string from = number_text(was.value), to = number_text(now->value);
    if (breaks)
      broken.push_back(was.where + ": " + was.key + " went from " + from + " to " + to +
                       ", more than the bound of " + ConfigNode::of(bound->second).scalar +
                       (was.better == Better::higher ? " lets it fall" : " allows"));
    const std::string change = was.value > 0 && now->value > 0 ? "×" + number_text(now->value / was.value)
                                                               : (now->value > was.value ? "+" : "") +
                                                                     number_text(now->value - was.value);
    if (!word.empty() || breaks)
      rows.push_back({was.where, was.key, from, to, change, word + (breaks ? " (bound broken)" : "")});
  }
  if (counts.empty())
    throw std::runtime_error("nothing of " + before.name + " is in " + after.name + " too: no method" +
                             (named ? ", variation and seed" : "") + " in common");
  for (const auto& [key, ratio] : ratios)
    if (met[key] == 0)
      throw std::runtime_error("--bound " + key + ": no match has this quantity on both sides");

  Names first, second, changed;
  for (const auto& [name, was] : a.converged) {
    const auto now = b.converged.find(name);
    const bool gone = now == b.converged.end();
    if (gone)
      first.push_back(name);
    else if (now->second != was)
      changed.push_back(
          name + (was ? ": converged before and does not now" : ": did not converge before and does now"));
    if (!ratios.empty() && (gone || (was && !now->second)))
      broken.push_back(name + (gone ? ": is in the first alone" : ": converged before and does not now") +
                       "; no bound holds");
  }
  for (const auto& [name, now] : b.converged)
    if (!a.converged.contains(name)) second.push_back(name);

  std::string text = rows.size() > 1 ? text_table(rows) + "\n" : "";
  Names sums;
  for (const char* word : {"faster", "slower", "less work", "more work", "better", "worse", "other", ""})
    if (counts.contains(word))
      sums.push_back(std::to_string(counts[word]) + " " + (*word ? word : "the same"));
  text +=
      joined(sums) +
      ". Times within 10 % or 0.05 s of each other, and other quantities within 1 %, count as the same.\n";
  if (!differing.empty())
    text += "Energies have no verdict, as their models differ: in " + joined(first_of(differing, 12)) + ".\n";
  for (const auto& [what, names] :
       {std::pair("only in the first: ", first), {"only in the second: ", second}, {"", changed}})
    for (const std::string& name : first_of(names, 40)) text += what + name + "\n";
  for (const std::string& line : broken) text += "broken: " + line + "\n";
  if (!ratios.empty() && broken.empty())
    text += ratios.size() == 1 ? "The bound holds.\n" : "All bounds hold.\n";
  return {text, !broken.empty()};
}

}  // namespace drape
