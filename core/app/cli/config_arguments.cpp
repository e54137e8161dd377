#include "core/app/cli/config_arguments.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "core/app/experiment/exit_codes.h"
#include "core/app/experiment/plausibility.h"
#include "core/app/run/start_repair.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

std::string positive_integer(const std::string& text) {
  const std::optional<int> number = parse_integer(text);
  return number && *number > 0 ? "" : "must be an integer of at least 1, not " + text;
}

std::function<std::string(const std::string&)> number_of_at_least(double least) {
  return [least](const std::string& text) {
    const std::optional<double> number = parse_number(text);
    return number && std::isfinite(*number) && *number >= least
               ? ""
               : "must be a number of at least " + three_digits(least) + ", not " + excerpt(text);
  };
}

namespace {

/// The remedy for a missing mesh of the folder data/, which the project fetches and does not hold.
std::string remedy(const std::string& message) {
  const std::size_t at = message.find("data/");
  const bool in_data =
      at != std::string::npos && (at == 0 || message[at - 1] == '/' || message[at - 1] == ' ');
  return in_data && message.find("No such file") != std::string::npos ? "; `make data` makes it" : "";
}

}  // namespace

int report_errors(const ConfigErrors& errors) {
  constexpr std::size_t most_listed = 40;
  for (std::size_t k = 0; k < std::min(errors.size(), most_listed); ++k)
    std::cerr << "error: " << errors[k].text() << remedy(errors[k].message) << "\n";
  if (errors.size() > most_listed) std::cerr << "error: and " << errors.size() - most_listed << " more\n";
  return exit_bad_input;
}

void warn_of(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) std::cerr << "warning: " << printable(line) << "\n";
}

void ConfigArguments::add_to(CLI::App& command) {
  config_option = command.add_option("experiment", config, "experiment file (YAML)")->required();
  command.add_option("--set", sets, "override one value, as in newton.step_size=0.1; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_option("--levels", levels, "number of levels, in place of the experiment's")
      ->type_name("N")
      ->check(positive_integer);
  command.add_flag("--allow-start-repair", allow_start_repair,
                   "translate an intersecting start up or sideways until it is free");
  command.add_flag("--allow-memory", allow_memory,
                   "allow a run that may need more memory than this machine has");
}

Overrides ConfigArguments::overrides() const {
  Overrides all;
  for (const std::string& set : sets) {
    const std::size_t equals = set.find('=');
    if (equals == std::string::npos || equals == 0)
      throw std::runtime_error("--set " + set + ": write it as key=value, as in --set newton.step_size=0.1");
    all.push_back({set.substr(0, equals), set.substr(equals + 1)});
  }
  if (levels > 0) all.push_back({"levels", std::to_string(levels), "--levels"});
  return all;
}

Loaded::Loaded(const ConfigArguments& arguments, const Registry& registry) {
  ConfigErrors errors;
  experiment = read_experiment(arguments.config, arguments.overrides(), registry, errors);
  if (errors.empty()) refuse_too_large(*experiment, arguments.large_memory(), errors);
  if (errors.empty())
    scene =
        build_scene(*experiment, errors,
                    arguments.allow_start_repair ? IntersectingStart::allowed : IntersectingStart::refused);
  if (scene && arguments.allow_start_repair) repair(errors);
  if (!errors.empty()) {
    exit_code = report_errors(errors);
    return;
  }
  summary = summary_of(*scene);
  std::vector<std::string> warnings;
  for (const ConfigError& warning : plausibility_warnings(*experiment, *scene, summary))
    warnings.push_back(warning.text());
  warn_of(warnings);
}

void Loaded::repair(ConfigErrors& errors) {
  const Eigen::Vector3d translation = repair_start(*experiment, *scene, errors);
  if (translation.isZero(0)) return;
  scene = build_scene(*experiment, errors);
  if (errors.empty())
    std::fprintf(stderr, "start moved by (%.4g, %.4g, %.4g) m; it touches nothing now\n", translation.x(),
                 translation.y(), translation.z());
}

}  // namespace drape
