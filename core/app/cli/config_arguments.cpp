#include "core/app/cli/config_arguments.h"

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <limits>

#include "core/app/cli/commands.h"
#include "core/app/setup/build_scene.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/config_node.h"

namespace drape {

OptionCheck must_be(const std::string& what, const std::function<bool(const std::string&)>& holds) {
  return [=](const std::string& text) {
    return holds(text) ? "" : "must be " + what + ", not " + excerpt(text);
  };
}

OptionCheck one_of(const std::vector<std::string>& words) {
  return must_be(joined(words, ", ", " or "),
                 [=](const std::string& text) { return is_one_of(text, words); });
}

OptionCheck integer_between(int least, int most, const std::string& what) {
  return must_be(what, [=](const std::string& text) {
    const std::optional<int> number = parse_integer(text);
    const std::size_t first = text.find_first_not_of("+-");
    const bool is_octal = first != text.npos && first + 1 < text.size() && text[first] == '0';  // to CLI11
    return number && !is_octal && *number >= least && *number <= most;
  });
}

OptionCheck positive_integer() {
  constexpr int most = std::numeric_limits<int>::max();
  return [](const std::string& text) {
    const bool digits = !text.empty() && text.find_first_not_of("0123456789") == text.npos;
    const bool too_large = digits && !parse_integer(text);
    return integer_between(
        1, most,
        too_large ? "an integer of at most " + std::to_string(most) : "an integer of at least 1")(text);
  };
}

OptionCheck number_of_at_least(double least) {
  return must_be("a number of at least " + three_digits(least), [least](const std::string& text) {
    const std::optional<double> number = number_of(text);
    return number && *number >= least;
  });
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

void RefusedConfig::list() const {
  constexpr std::size_t most_listed = 40;
  for (std::size_t k = 0; k < std::min(errors.size(), most_listed); ++k)
    std::cerr << "error: " << errors[k].text() << remedy(errors[k].message) << "\n";
  if (errors.size() > most_listed) std::cerr << "error: and " << errors.size() - most_listed << " more\n";
}

void require_none(const ConfigErrors& errors) {
  if (!errors.empty()) throw RefusedConfig{errors};
}

void warn_of(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) std::cerr << "warning: " << printable(line) << "\n";
}

CLI::Option* ConfigArguments::add_overrides_to(CLI::App& command) {
  CLI::Option* file = command.add_option("experiment", config, "experiment file (YAML)")->required();
  add_option(command, "--set KEY=VALUE", sets,
             "override one value, as in newton.step_size=0.1; may be repeated");
  add_option(command, "--levels N", levels, "number of levels, in place of the experiment's")
      ->check(positive_integer());
  command.add_flag("--allow-memory", allow_memory,
                   "allow a run that may need more memory than this machine has");
  return file;
}

CLI::Option* ConfigArguments::add_to(CLI::App& command) {
  CLI::Option* file = add_overrides_to(command);
  command.add_flag("--allow-start-repair", allow_start_repair,
                   "move an intersecting start as a whole, the shortest way that leads across no obstacle");
  return file;
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

LoadedExperiment::LoadedExperiment(const ConfigArguments& arguments, const Registry& registry) {
  ConfigErrors errors;
  auto read =
      read_experiment(arguments.config, arguments.overrides(), registry, errors, arguments.large_memory());
  require_none(errors);
  experiment = std::move(*read);
  const bool repair = arguments.allow_start_repair;
  scene = build_scene(experiment, errors, arguments.large_memory(),
                      repair ? IntersectingStart::allowed : IntersectingStart::refused);
  require_none(errors);
  const Eigen::Vector3d moved =
      repair ? repair_start(experiment, *scene, errors) : Eigen::Vector3d(Eigen::Vector3d::Zero());
  if (!moved.isZero(0)) scene = build_scene(experiment, errors, arguments.large_memory());
  require_none(errors);
  if (!moved.isZero(0))
    std::fprintf(stderr, "start moved by (%.4g, %.4g, %.4g) m; it touches nothing now\n", moved.x(),
                 moved.y(), moved.z());
  summary = summary_of(*scene);
  for (const ConfigError& warning : plausibility_warnings(experiment, *scene, summary))
    warn_of({warning.text()});
}

}  // namespace drape
