#include "core/app/sweep/fit.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/app/experiment/experiment_path.h"
#include "core/app/report/run_data.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {
namespace {

std::optional<double> value_of(const ConfigNode* node) {
  return node && node->is_number() ? std::optional(node->number) : std::nullopt;
}

/// Appends the paths of all numbers in a node.
void list_numbers(const ConfigNode& node, const std::string& path, std::vector<std::string>& paths) {
  if (value_of(&node)) paths.push_back(path);
  const std::string before = path.empty() ? "" : path + ".";
  for (const auto& [key, value] : node.entries) list_numbers(value, before + key, paths);
  for (std::size_t k = 0; k < node.items.size(); ++k)
    list_numbers(node.items[k], before + std::to_string(k), paths);
}

/// Whether stiffnesses by direction replace a modulus, which a saved material has all the same.
bool is_replaced(const ConfigNode& section, const std::string& key) {
  return (key == "bending_modulus" && value_of(section.find("warp_bending"))) ||
         (key == "membrane_modulus" && value_of(section.find("warp_stiffness")));
}

/// The numbers of a group: of a section's path with a part of a key's name. Those that are written, or else
/// the defaults.
std::vector<ScaledKey> group(const ConfigNode& source, const ConfigNode& resolved, const std::string& path) {
  static const ConfigNode plain = node_of(ExperimentParameters());
  std::vector<ScaledKey> changed, defaults;
  const std::size_t dot = path.rfind('.');
  const ConfigNode* section = dot == std::string::npos ? nullptr : value_at(resolved, path.substr(0, dot));
  if (!section) return {};
  for (const auto& [key, node] : section->entries) {
    const std::optional<double> value = value_of(&node);
    if (!value || *value == 0 || key.find(path.substr(dot + 1)) == std::string::npos) continue;
    const std::string own = path.substr(0, dot + 1) + key;
    const bool is_written = value_at(source, own) && !is_replaced(*section, key),
               is_default = !is_written && value_of(value_at(plain, own)) == value;
    (is_default ? defaults : changed).push_back({own, *value});
  }
  return changed.empty() ? defaults : changed;
}

std::string fault(const ConfigNode& resolved, const std::string& path) {
  const std::string name = "\"" + excerpt(path) + "\"";
  if (const ConfigNode* node = value_at(resolved, path)) {
    if (node->kind == ConfigNode::Kind::null)
      return name + " is not set, so there is nothing to scale; give it a value with --set";
    return name + " is " + (value_of(node) ? "0, which no factor changes" : node->shown() + ", not a number");
  }
  std::vector<std::string> all;
  list_numbers(resolved, "", all);
  return "the experiment has no number " + name + "; " +
         did_you_mean(path, all, "`drape describe experiment` lists its keys");
}

const std::string prefix = "factor=";

std::string name_of(double factor) { return prefix + ConfigNode::of(factor).scalar; }

/// The number, rounded to `digits` significant digits.
double rounded(double value, int digits) { return parse_number(general_text(value, digits)).value(); }

const double first_step = std::log(4), last_place = std::log(1024);
constexpr double least_step = 0.05;      ///< towards a factor that is not known
constexpr double least_interval = 1e-3;  ///< of the logarithm

/// A factor's logarithm with its residual.
struct Place {
  double x, residual;
};
/// Ends the library's search.
struct Interrupted {
  FitEnd end;
};

/// Goes on between two places of different sign; `at` evaluates the residual, at most `left` times more.
template <class At>
FitEnd search_between(Place low, Place high, const At& at, const int& left) {
  if (low.x > high.x) std::swap(low, high);
  bool reached = false;
  const auto f = [&](double x) {
    if (left == 0) throw Interrupted{FitEnd::exhausted};
    const std::optional<double> residual = at(x);
    if (!residual) throw Interrupted{FitEnd::interrupted};
    reached = *residual == 0;
    return *residual;
  };
  const auto is_narrow = [](double from, double to) { return to - from < least_interval; };
  auto most = static_cast<std::uintmax_t>(left) + 3;  // it counts in its own way
  try {
    boost::math::tools::toms748_solve(f, low.x, high.x, low.residual, high.residual, is_narrow, most);
  } catch (const Interrupted& interrupted) {
    return interrupted.end;
  }
  return reached ? FitEnd::reached : FitEnd::jumps;
}

}  // namespace

double ScaledKey::times(double factor) const { return rounded(value * factor, 6); }

std::vector<ScaledKey> scaled_keys(const Experiment& experiment, const std::vector<std::string>& paths,
                                   const std::string& option, ConfigErrors& errors) {
  std::vector<ScaledKey> keys;
  for (const std::string& path : paths) {
    const ConfigNode* node = value_at(experiment.resolved, path);
    const double value = value_of(node).value_or(0);
    std::vector<ScaledKey> named{{path, value}};
    if (!node) named = group(experiment.source, experiment.resolved, path);
    if (named.empty() || (node && value == 0))
      errors.push_back({{option, 0, 0}, fault(experiment.resolved, path)});
    for (const ScaledKey& key : named)
      if (std::ranges::find(keys, key.path, &ScaledKey::path) == keys.end()) keys.push_back(key);
  }
  return keys;
}

std::optional<Sweep> FitSetup::sweep(const std::set<double>& factors, const Registry& registry,
                                     ConfigErrors& errors) const {
  ConfigNode source;
  source.where.file = config;
  source.add("name", ConfigNode::of(name));
  source.add("base", ConfigNode::of(config));
  if (!set.entries.empty()) source.add("set", set);
  source.add("repeats", ConfigNode::of(starts));
  source.entries.back().second.where.file = "--starts";
  ConfigNode methods(ConfigNode::Kind::list), variations(ConfigNode::Kind::list);
  methods.items.push_back(ConfigNode::of(method));
  source.add("methods", methods);
  for (const double factor : factors) {
    ConfigNode variation, values;
    for (const ScaledKey& key : keys) values.add(key.path, ConfigNode::of(key.times(factor)));
    variation.add("name", ConfigNode::of(name_of(factor)));
    variation.add("set", values);
    variations.items.push_back(variation);
  }
  source.add("ablation", variations);
  return read_sweep(std::move(source), registry, errors);
}

double FitSample::median() const {
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

FitRuns::FitRuns(const FitSetup& setup, const SweepFolder& folder, const SweepOptions& options,
                 const Registry& registry)
    : setup_(setup), folder_(folder), options_(options), registry_(registry) {
  const Json before = folder.find();
  if (before.is_null() || before["sweep"] != setup.name) return;
  for (const auto& run : before["runs"]) {
    const std::string name = run["name"];
    if (!name.starts_with(prefix)) continue;
    if (const auto factor = parse_number(name.substr(prefix.size()))) factors_.insert(*factor);
  }
}

const FitSample& FitRuns::at(double factor) {
  for (const FitSample& sample : samples_)
    if (sample.factor == factor) return sample;
  std::set<double> factors = factors_;
  factors.insert(factor);
  ConfigErrors errors, own;
  const std::optional<Sweep> sweep = setup_.sweep(factors, registry_, errors);
  if (!sweep) {
    if (setup_.sweep({factor}, registry_, own))
      refuse_path(folder_.path(),
                  "has runs of another fit (" + errors[0].text() + "); name another folder with --out");
    FitSample sample;
    sample.factor = factor;
    for (const ConfigError& error : own) sample.left_out.push_back(error.text());
    return samples_.emplace_back(std::move(sample));
  }
  factors_ = factors;
  std::vector<std::size_t> missing = folder_.prepare(*sweep, options_.threads, true);
  begun_ = true;
  std::erase_if(missing, [&](std::size_t k) { return sweep->runs[k].name != name_of(factor); });
  run_locally(*sweep, folder_, missing, options_);
  if (options_.stop()) throw FitStopped();
  return samples_.emplace_back(measured(*sweep, factor));
}

FitSample FitRuns::measured(const Sweep& sweep, double factor) const {
  FitSample sample;
  sample.factor = factor;
  for (const SweepRun& run : sweep.runs) {
    if (run.name != name_of(factor)) continue;
    if (sample.config.empty()) sample.config = run.config;
    const RunFiles files = folder_.files(run.folder);
    const RunStatus status = read_status(files);
    const auto leave_out = [&](const std::string& why) {
      sample.left_out.push_back("start " + std::to_string(run.seed) + " " + why + "; see " +
                                files.folder.string());
    };
    if (status.state != RunState::converged) {
      leave_out(status.has_results() ? "did not converge"
                                     : "failed: " + status.error.substr(0, status.error.find('\n')));
      continue;
    }
    const MethodRecord method = read_run(files.folder).methods.at(0);
    const std::optional<double> value = number_member(method.levels.back().values, setup_.metric);
    value ? sample.values.push_back(*value) : leave_out("has no " + setup_.metric);
  }
  std::ranges::sort(sample.values);
  return sample;
}

FitEnd find_factor(const std::function<std::optional<double>(double factor)>& residual_of, int left) {
  const auto at = [&](double x) {
    --left;
    return residual_of(rounded(std::exp(x), 4));
  };
  const std::optional<double> first = at(0);
  if (!first) return FitEnd::out_of_reach;
  Place last{0, *first};
  double direction = 1, step = first_step;
  bool may_turn = true;
  const auto turn = [&] { direction = -1, step = first_step, may_turn = false; };
  while (last.residual != 0) {
    const double x = direction * std::min(std::abs(last.x) + step, last_place);
    if (x == last.x) return FitEnd::out_of_reach;
    if (left == 0) return FitEnd::exhausted;
    const std::optional<double> residual = at(x);
    if (!residual) {
      step /= 2;
      if (step >= least_step) continue;
      if (!may_turn) return FitEnd::out_of_reach;
      turn();
    } else if (*residual * last.residual < 0) {
      return search_between(last, {x, *residual}, at, left);
    } else if (std::abs(*residual) > std::abs(*first) && may_turn) {
      turn();
    } else {
      last = {x, *residual};
      may_turn = false;
    }
  }
  return FitEnd::reached;
}

}  // namespace drape
