#include "core/app/sweep/fit_runs.h"

#include <algorithm>

#include "core/app/report/run_data.h"
#include "core/app/sweep/local_engine.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {
namespace {

const std::string prefix = "factor=";

std::string name_of(double factor) { return prefix + ConfigNode::of(factor).scalar; }

/// To six digits: what a person reads, and far finer than any fit.
double six_digits(double value) { return parse_number(general_text(value, 6)).value(); }

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

std::optional<Sweep> FitSetup::sweep(const std::set<double>& factors, const Registry& registry,
                                     ConfigErrors& errors) const {
  ConfigNode source;
  source.where.file = config;
  source.add("name", ConfigNode::of(name));
  source.add("base", ConfigNode::of(config));
  if (!set.entries.empty()) source.add("set", set);
  source.add("repeats", ConfigNode::of(starts));
  source.entries.back().second.where.file = "--starts";
  ConfigNode methods, variations;
  methods.kind = variations.kind = ConfigNode::Kind::list;
  methods.items.push_back(ConfigNode::of(method));
  source.add("methods", methods);
  for (const double factor : factors) {
    ConfigNode variation, values;
    for (const ScaledKey& key : keys) values.add(key.path, ConfigNode::of(six_digits(key.value * factor)));
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

double FitSample::scaled(const ScaledKey& key) const { return six_digits(key.value * factor); }

FitRuns::FitRuns(const FitSetup& setup, const SweepFolder& folder, const SweepOptions& options,
                 const Registry& registry)
    : setup_(setup), folder_(folder), options_(options), registry_(registry) {
  const nlohmann::ordered_json before = folder.read();
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
  ConfigErrors errors;
  const std::optional<Sweep> sweep = setup_.sweep(factors, registry_, errors);
  FitSample sample;
  sample.factor = factor;
  for (const ConfigError& error : errors) sample.left_out.push_back(error.text());
  if (!sweep) return samples_.emplace_back(std::move(sample));
  factors_ = factors;
  folder_.prepare(*sweep, options_.threads);
  std::vector<std::size_t> missing = folder_.missing(*sweep, true);
  std::erase_if(missing, [&](std::size_t k) { return sweep->runs[k].name != name_of(factor); });
  run_locally(*sweep, folder_, missing, options_);
  folder_.refresh();
  if (options_.stop && options_.stop()) throw FitStopped();
  return samples_.emplace_back(measured(*sweep, factor));
}

bool FitRuns::has(double factor) const {
  return std::any_of(samples_.begin(), samples_.end(),
                     [&](const FitSample& sample) { return sample.factor == factor; });
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
      leave_out(status.has_results() ? "did not converge" : "failed: " + first_line(status.error));
      continue;
    }
    const MethodRecord method = read_run(files.folder).methods.at(0);
    const OptionalNumber value = method.levels.back().values.of(setup_.metric);
    value ? sample.values.push_back(*value) : leave_out("has no " + setup_.metric);
  }
  std::sort(sample.values.begin(), sample.values.end());
  return sample;
}

}  // namespace drape
