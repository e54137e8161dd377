#include "core/app/report/compare.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "core/app/report/model_keys.h"
#include "core/app/report/run_rows.h"
#include "core/app/report/text_table.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

namespace {

constexpr double time_noise = 0.10;      // smaller relative differences of times count as equal
constexpr double least_seconds = 0.05;   // smaller differences of times count as equal [s]
constexpr double relative_noise = 0.01;  // the same for all other quantities

/// What is compared of every level.
constexpr const char* level_keys[] = {"seconds",         "iterations",    "flops",
                                      "energy_released", "intersections", "smallest_gap"};

/// The quantities that one or both sides have, beside level_keys.
struct ComparedQuantities {
  std::vector<RowQuantity> rows;
  std::vector<MetricColumn> states, pairs;

  ComparedQuantities(const RunCollection& before, const RunCollection& after) {
    std::vector<DeclaredMetric> metrics = before.metrics();
    merge(metrics, after.metrics());
    states = columns_of(metrics, MetricScope::state, Shown::summary);
    pairs = columns_of(metrics, MetricScope::pair, Shown::tables);
    rows = row_quantities(before.error_measures());
    for (RowQuantity& f : row_quantities(after.error_measures()))
      if (std::none_of(rows.begin(), rows.end(), [&](const RowQuantity& own) { return own.name == f.name; }))
        rows.push_back(std::move(f));
  }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    const auto add = [&](const std::string& name) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    };
    for (const char* key : level_keys) add(key);
    for (const auto* columns : {&states, &pairs})
      for (const MetricColumn& column : *columns) add(column.name);
    for (const RowQuantity& f : rows) add(f.name);
    return names;
  }

  Better better(const std::string& name) const {
    for (const auto* columns : {&states, &pairs})
      for (const MetricColumn& column : *columns)
        if (column.name == name) return column.better;
    return name == "smallest_gap" || name == "energy_released" ? Better::higher : Better::lower;
  }
};

bool is_time(const std::string& key) { return key == "seconds" || key == "preview_seconds"; }
bool is_work(const std::string& key) { return key == "iterations" || key == "flops"; }

/// One quantity of one run.
struct Entry {
  std::string where, key;
  double value;
  const RunData* run;
};

/// Values by level and key, in file order, and whether each method converged.
struct Sheet {
  std::vector<Entry> entries;
  std::vector<std::pair<std::string, bool>> converged;
  const RunData* run = nullptr;  ///< whose values are added

  void add(const std::string& where, const std::string& key, const OptionalNumber& value) {
    if (value) entries.push_back({where, key, *value, run});
  }
  const Entry* find(const std::string& where, const std::string& key) const {
    for (const Entry& entry : entries)
      if (entry.where == where && entry.key == key) return &entry;
    return nullptr;
  }
};

void add_method(Sheet& sheet, const ComparedQuantities& quantities, const std::string& prefix,
                const RunData& run, const MethodRecord& method) {
  const std::string name = prefix + method.name;
  sheet.converged.emplace_back(name, has_converged(method.status));
  for (const RowQuantity& f : quantities.rows) sheet.add(name, f.name, f.of(run, method));
  if (method.levels.size() > 1)
    for (const LevelRecord& level : method.levels) {
      const std::string where = name + ", level " + std::to_string(level.level);
      for (const char* key : level_keys) sheet.add(where, key, level.*level_quantity(key).member);
      for (const MetricColumn& column : quantities.states)
        sheet.add(where, column.name, level.metrics.of(column.name));
    }
  else if (!method.levels.empty())
    for (const char* key : {"intersections", "smallest_gap"})
      sheet.add(name, key, method.levels.front().*level_quantity(key).member);
  for (const ConsistencyRecord& pair : method.consistency)
    for (const MetricColumn& column : quantities.pairs)
      sheet.add(name + ", levels " + std::to_string(pair.coarse) + " → " + std::to_string(pair.fine),
                column.name, pair.metrics.of(column.name));
}

Sheet sheet_of(const RunCollection& collection, const ComparedQuantities& quantities, bool named) {
  Sheet sheet;
  for (const RunRecord& run : collection.runs) {
    std::string prefix;
    if (named)
      prefix = run.variation + (run.seed ? ", seed " + std::to_string(std::llround(*run.seed)) : "") + ": ";
    if (!run.data) continue;
    sheet.run = &*run.data;
    for (const MethodRecord& method : run.data->methods)
      add_method(sheet, quantities, prefix, *run.data, method);
  }
  return sheet;
}

std::string verdict(const Change& c) {
  const double difference = c.after - c.before;
  const double noise = is_time(c.key) ? time_noise : relative_noise;
  if (std::abs(difference) <= noise * std::min(std::abs(c.before), std::abs(c.after))) return "";
  if (difference == 0 || (is_time(c.key) && std::abs(difference) < least_seconds)) return "";
  if (c.better == Better::neither) return "other";
  const bool good = (difference < 0) != (c.better == Better::higher);
  if (is_time(c.key)) return good ? "faster" : "slower";
  if (is_work(c.key)) return good ? "less work" : "more work";
  return good ? "better" : "worse";
}

/// What a cloth releases may be negative and counts zero: a ratio is relative to the absolute value.
bool holds(const Change& c, double ratio) {
  if (is_time(c.key) && c.after - c.before < least_seconds) return true;
  if (c.better == Better::higher && c.before >= 0) return c.after * ratio >= c.before;
  if (c.better == Better::higher) return c.after >= c.before * ratio;
  return c.after <= c.before + (ratio - 1) * std::abs(c.before);
}

/// In which keys of their model two runs differ, read once for each two.
class ModelDifferences {
 public:
  const std::vector<std::string>& of(const RunData& a, const RunData& b) {
    const auto [found, is_new] = known_.try_emplace({&a, &b});
    if (is_new) found->second = differing_model_keys(a.configuration, b.configuration);
    return found->second;
  }

 private:
  std::map<std::pair<const RunData*, const RunData*>, std::vector<std::string>> known_;
};

std::string change_of(const Change& c) {
  if (c.before > 0 && c.after > 0) return "×" + number_text(c.after / c.before);
  return (c.after > c.before ? "+" : "") + number_text(c.after - c.before);
}

}  // namespace

std::vector<Bound> parse_bounds(const std::vector<std::string>& texts, const RunCollection& before,
                                const RunCollection& after) {
  std::vector<Bound> bounds;
  const std::vector<std::string> known = ComparedQuantities(before, after).names();
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw std::runtime_error("--bound " + text + ": write it as KEY=RATIO, as in --bound seconds=1.1");
    const std::string key = text.substr(0, equals);
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      const std::string near = nearest_word(key, known);
      throw std::runtime_error(
          "--bound " + excerpt(text) + ": there is no quantity \"" + excerpt(key) + "\"; " +
          (near.empty() ? "there are " + joined(known) : "did you mean \"" + near + "\"?"));
    }
    const std::optional<double> ratio = parse_number(text.substr(equals + 1));
    if (!ratio || !std::isfinite(*ratio) || *ratio <= 0)
      throw std::runtime_error("--bound " + text + ": the ratio must be a number above 0, as in --bound " +
                               key + "=1.1");
    bounds.push_back({key, *ratio});
  }
  return bounds;
}

Comparison::Comparison(const RunCollection& before, const RunCollection& after,
                       const std::vector<Bound>& bounds)
    : bounds_(bounds.size()) {
  const bool named = before.runs.size() > 1 || after.runs.size() > 1;
  const ComparedQuantities quantities(before, after);
  const Sheet a = sheet_of(before, quantities, named), b = sheet_of(after, quantities, named);
  ModelDifferences differences;
  for (const Entry& was : a.entries)
    if (const Entry* now = b.find(was.where, was.key)) {
      Change& change = changes_.emplace_back(
          Change{was.where, was.key, was.value, now->value, quantities.better(was.key)});
      if (was.key != "energy_released") {
        change.verdict = verdict(change);
        continue;
      }
      const std::vector<std::string>& keys = differences.of(*was.run, *now->run);
      change.verdict = keys.empty() ? verdict(change) : "other";
      for (const std::string& key : keys)
        if (std::find(differing_.begin(), differing_.end(), key) == differing_.end())
          differing_.push_back(key);
    }
  if (changes_.empty())
    throw std::runtime_error("nothing of " + before.name + " is in " + after.name + " too: no method" +
                             (named ? ", variation and seed" : "") + " in common");
  const auto method_lists = [](const Sheet& from, const Sheet& in, std::vector<std::string>& list) {
    for (const auto& [name, converged] : from.converged)
      if (std::none_of(in.converged.begin(), in.converged.end(),
                       [&n = name](const auto& other) { return other.first == n; }))
        list.push_back(name);
  };
  method_lists(a, b, lost_);
  method_lists(b, a, gained_);

  for (const Bound& bound : bounds) {
    int met = 0;
    for (Change& change : changes_) {
      if (change.key != bound.key) continue;
      ++met;
      if (holds(change, bound.ratio)) continue;
      change.broken = true;
      broken_.push_back(change.where + ": " + bound.key + " went from " + number_text(change.before) +
                        " to " + number_text(change.after) + ", more than the bound of " +
                        ConfigNode::of(bound.ratio).scalar +
                        (change.better == Better::higher ? " lets it fall" : " allows"));
    }
    if (met == 0)
      throw std::runtime_error("--bound " + bound.key + ": no match has this quantity on both sides");
  }
  if (bounds.empty()) return;
  for (const std::string& name : lost_) broken_.push_back(name + ": is in the first alone; no bound holds");
  for (const auto& [name, was] : a.converged)
    for (const auto& [other, is] : b.converged)
      if (name == other && was && !is)
        broken_.push_back(name + ": converged before and does not now; no bound holds");
}

std::string Comparison::text() const {
  std::map<std::string, int> counts;
  std::vector<std::vector<std::string>> rows = {
      {"where", "quantity", "before", "after", "change", "verdict"}};
  for (const Change& c : changes_) {
    ++counts[c.verdict];
    if (!c.verdict.empty() || c.broken)
      rows.push_back({c.where, c.key, number_text(c.before), number_text(c.after), change_of(c),
                      c.verdict + (c.broken ? " (bound broken)" : "")});
  }
  std::string text = rows.size() > 1 ? text_table(rows) + "\n" : "";
  for (const char* word : {"faster", "slower", "less work", "more work", "better", "worse", "other", ""})
    if (counts.count(word))
      text += (text.empty() || text.back() == '\n' ? "" : ", ") + std::to_string(counts[word]) + " " +
              (*word ? word : "the same");
  text +=
      ". Times within 10 % or 0.05 s of each other, and other quantities within 1 %, count as the same.\n";
  const auto list = [&](const char* where, const std::vector<std::string>& names) {
    constexpr std::size_t most_listed = 40;
    for (std::size_t k = 0; k < std::min(names.size(), most_listed); ++k)
      text += std::string("only in the ") + where + ": " + names[k] + "\n";
    if (names.size() > most_listed)
      text += std::string("only in the ") + where + ": and " + std::to_string(names.size() - most_listed) +
              " more\n";
  };
  if (!differing_.empty()) {
    constexpr std::size_t most_named = 12;
    std::vector<std::string> keys = differing_;
    if (keys.size() > most_named) {
      keys.resize(most_named);
      keys.push_back("…");
    }
    text += "Energies have no verdict, as their models differ: in " + joined(keys) + ".\n";
  }
  list("first", lost_);
  list("second", gained_);
  for (const std::string& line : broken_) text += "broken: " + line + "\n";
  if (bounds_ > 0 && broken_.empty()) text += bounds_ == 1 ? "The bound holds.\n" : "All bounds hold.\n";
  return text;
}

}  // namespace drape
