#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

#include "core/app/cli/commands.h"
#include "core/app/cli/config_arguments.h"
#include "core/app/experiment/declared_metrics.h"
#include "core/app/experiment/exit_codes.h"
#include "core/app/experiment/experiment_path.h"
#include "core/app/files/json_file.h"
#include "core/app/files/machine.h"
#include "core/app/files/yaml_file.h"
#include "core/app/sweep/fit.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/config_node.h"
#include "core/kernel/threads/parallel.h"

namespace drape {
namespace {

constexpr int most_evaluations = 24;

struct FitRequest : ConfigArguments, SweepOptions {
  FitSetup setup;
  double target = 0, tolerance = 1;  ///< tolerance in percent of the target
  std::vector<std::string> by;
  std::string folder;
};

std::string digits(double value) { return general_text(value, 4); }

/// Appends an error unless a metric of the experiment has this column; without a name, the first column is
/// taken.
void choose_metric(const Experiment& experiment, std::string& metric, ConfigErrors& errors) {
  std::vector<std::string> names;
  for (const MetricColumn& column :
       columns_of(declared_metrics(experiment.metrics), MetricScope::state, Shown::stored))
    names.push_back(column.name);
  if (metric.empty() && !names.empty()) metric = names.front();
  if (is_one_of(metric, names)) return;
  errors.push_back({{"--metric", 0, 0},
                    "the experiment's metrics have no \"" + excerpt(metric) + "\"; " +
                        did_you_mean(metric, names,
                                     names.empty() ? "name one of `drape list metric` in its \"metrics\""
                                                   : "they are " + joined(names))});
}

/// Checks the request, and completes its setup and folder.
void complete(FitRequest& request, const Registry& registry) {
  ConfigErrors errors;
  const auto experiment = read_experiment(request.config, request.overrides(), registry, errors);
  require_none(errors);
  FitSetup& setup = request.setup;
  setup.config = request.config;
  setup.name = experiment->parameters.name + "_fit";
  setup.keys = scaled_keys(*experiment, request.by, "--by", errors);
  for (const ScaledKey& key : setup.keys) refuse_scheduled(experiment->source, key.path, "--by", errors);
  choose_metric(*experiment, setup.metric, errors);
  if (setup.method == all_methods) throw std::runtime_error("--method: a fit takes one method");
  setup.method = chosen_methods(
      *experiment, setup.method.empty() ? std::vector<std::string>() : std::vector{setup.method})[0];
  for (const Override& o : request.overrides())
    if (const auto value = value_of_option(o.value, o.option, errors)) setup.set.add(o.key, *value);
  require_none(errors);
  const std::optional<Sweep> sweep = setup.sweep({1}, registry, errors);
  require_none(errors);
  if (request.folder.empty()) request.folder = "results/" + setup.name;
  const SweepFolder folder(request.folder);
  if (!request.allow_memory) MemoryEstimate(*sweep, folder).require(*sweep, folder, machine_memory());
}

void tell(const FitSetup& setup, const FitSample& sample) {
  std::string line = "factor " + digits(sample.factor) + "  " + setup.keys[0].path + " " +
                     digits(setup.keys[0].value * sample.factor) + "  ";
  if (!sample.values.empty())
    line += setup.metric + " " + digits(sample.median()) + " (" + digits(sample.values.front()) + " to " +
            digits(sample.values.back()) + ")";
  for (const std::string& why : sample.left_out)
    line += (sample.values.empty() && why == sample.left_out[0] ? "" : "\n  ") + why;
  std::fprintf(stderr, "%s\n", printable_lines(line).c_str());
}

/// The sample that is nearest to the target; null without any.
const FitSample* nearest_sample(const std::vector<FitSample>& samples, double target) {
  const FitSample* best = nullptr;
  for (const FitSample& sample : samples)
    if (!sample.values.empty() &&
        (!best || std::abs(sample.median() - target) < std::abs(best->median() - target)))
      best = &sample;
  return best;
}

/// Why a fit ended without its target.
std::string shortfall(FitEnd end, const FitRequest& request, const std::vector<FitSample>& samples) {
  const std::string target = request.setup.metric + " " + digits(request.target);
  if (end == FitEnd::jumps) return target + " lies in a jump between two factors that are almost equal";
  if (end == FitEnd::exhausted)
    return target + " was not met by " + std::to_string(most_evaluations) + " factors";
  if (end == FitEnd::interrupted) return target + " was not met: the last factor gave no value";
  double low = HUGE_VAL, high = -HUGE_VAL, least = HUGE_VAL, most = 0;
  for (const FitSample& sample : samples) {
    if (sample.values.empty()) continue;
    low = std::min(low, sample.median()), high = std::max(high, sample.median());
    least = std::min(least, sample.factor), most = std::max(most, sample.factor);
  }
  return target + " is out of reach: factors from " + digits(least) + " to " + digits(most) + " gave " +
         digits(low) + " to " + digits(high);
}

Json json_of(const FitSample& sample) {
  Json json = {{"factor", sample.factor}};
  if (!sample.values.empty())
    json.update(
        {{"median", sample.median()}, {"low", sample.values.front()}, {"high", sample.values.back()}});
  json["values"] = sample.values;
  json["left_out"] = sample.left_out;
  return json;
}

void write_fit(const SweepFolder& folder, const FitRequest& request, const std::vector<FitSample>& samples,
               const FitSample& best, bool reached) {
  const FitSetup& setup = request.setup;
  Json json = {{"experiment", setup.config}, {"method", setup.method},         {"metric", setup.metric},
               {"target", request.target},   {"tolerance", request.tolerance}, {"starts", setup.starts},
               {"reached", reached}};
  json.update(json_of(best));
  for (const ScaledKey& key : setup.keys) json["fitted"][key.path] = key.times(best.factor);
  json["samples"] = Json::array();
  for (const FitSample& sample : samples) json["samples"].push_back(json_of(sample));
  write_file(folder.path() / "fit.json", json_text(json, 1) + "\n");
  write_file(folder.path() / "fitted.yaml", best.config);
}

int show_result(const SweepFolder& folder, const FitRequest& request, const FitRuns& runs, FitEnd end) {
  const FitSetup& setup = request.setup;
  const FitSample* best = nearest_sample(runs.samples(), request.target);
  if (!best) {
    std::cerr << "error: no start gave a value\n";
    return exit_not_converged;
  }
  const bool reached = end == FitEnd::reached;
  write_fit(folder, request, runs.samples(), *best, reached);
  std::cout << setup.metric << " " << digits(best->median()) << " (" << digits(best->values.front()) << " to "
            << digits(best->values.back()) << " in " << best->values.size() << " of " << setup.starts
            << " starts) with\n ";
  for (const ScaledKey& key : setup.keys)
    std::cout << " --set " << printable(key.path) << "=" << ConfigNode::of(key.times(best->factor)).scalar;
  std::cout << "\nexperiment: " << printable((folder.path() / "fitted.yaml").string()) << "\n";
  if (!reached) std::cerr << "error: " << printable(shortfall(end, request, runs.samples())) << "\n";
  return reached && best->left_out.empty() ? exit_done : exit_not_converged;
}

int run_fit(FitRequest r, const Registry& registry) {
  complete(r, registry);
  const SweepFolder folder(r.folder);
  const auto lock = folder.lock();
  r.stop = [] { return stop_signal() != 0; };
  r.workers = std::max<int>(1, core_count() / r.threads);
  FitRuns runs(r.setup, folder, r, registry);
  stop_on_signals();  // nothing to save before this point
  try {
    const FitEnd end = find_factor(
        [&](double factor) -> std::optional<double> {
          const std::size_t before = runs.samples().size();
          const FitSample& sample = runs.at(factor);
          if (runs.samples().size() > before) tell(r.setup, sample);
          if (sample.values.empty()) return std::nullopt;
          const double residual = sample.median() - r.target;
          return std::abs(residual) <= r.tolerance / 100 * std::abs(r.target) ? 0 : residual;
        },
        most_evaluations);
    return show_result(folder, r, runs, end);
  } catch (const FitStopped&) {
    std::cerr << "stopped on request; the same command goes on\n";
    return exit_by_signal + stop_signal();
  } catch (const std::exception& error) {
    if (!runs.begun()) throw;
    std::cerr << "error: " << printable(reason_of(error)) << "; the same command goes on\n";
    return exit_aborted;
  }
}

}  // namespace

void add_fit_command(Commands& commands) {
  const auto request = std::make_shared<FitRequest>();
  FitRequest& r = *request;  // lives as long as the commands
  r.threads = 1, r.quiet = true;
  CLI::App& command = commands.add_with_plugins(
      "fit", "find the numbers of an experiment with which a metric has a measured value",
      "drape fit configs/tests/cusick.yaml --to 68.4 --by material.bending -o results/fit",
      [request](const Registry& registry) { return run_fit(*request, registry); });
  r.add_overrides_to(command);
  add_option(command, "--to NUMBER", r.target, "the value to be met")
      ->required()
      ->check(must_be("a number other than 0",
                      [](const std::string& text) { return number_of(text).value_or(0) != 0; }));
  add_option(command, "--by KEY", r.by,
             "a number to be scaled, as material.warp_bending; material.bending is every number of the "
             "material with bending in its name. May be repeated: one factor scales all")
      ->required();
  add_option(command, "--metric NAME", r.setup.metric,
             "column of a metric, on the finest level (default: the first of the experiment's metrics)");
  add_option(command, "--starts N", r.setup.starts,
             "runs of each factor, whose median counts: start.seed 1 to N (default: 3)")
      ->check(integer_between(1, 1000, "an integer from 1 to 1000"));
  add_option(command, "--tolerance PERCENT", r.tolerance,
             "of the median, in percent of the value to be met (default: 1)")
      ->check(number_of_at_least(1e-4));
  add_option(command, "--method NAME", r.setup.method, "method of the experiment (default: as of drape run)");
  add_option(command, "-o,--out FOLDER", r.folder,
             "folder of the runs and of the result (default: results/NAME_fit)");
  add_option(command, "--threads N", r.threads,
             "threads of each run; as many runs at a time as the cores allow")
      ->check(positive_integer());
}

}  // namespace drape
