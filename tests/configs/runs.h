#pragma once

#include <map>

#include "tests/support/command.h"

// What every test of this folder uses.
namespace fs = std::filesystem;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;

/// Runs e.yaml without a report into the folder `out`; it must end with this exit code.
inline Ended run_into(const std::string& out, const Scratch& folder, const std::string& options = "",
                      int exit_code = 0) {
  return drape_ends("run e.yaml --quiet --no-report --measure --out " + out + " " + options, folder,
                    exit_code);
}

/// The results of a run, in its folder.
inline nlohmann::json results_in(const fs::path& run) { return json_in(run / "results.json"); }

/// Changes what a JSON file holds, and leaves its keys in their order.
template <class Edit>
void edit_json(const fs::path& file, const Edit& edit) {
  auto all = nlohmann::ordered_json::parse(text_of(file));
  edit(all);
  std::ofstream(file, std::ios::binary) << all.dump();
}

/// The bytes of all files below a folder, by their path within it, and its folders.
inline std::map<std::string, std::string> files_in(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    files[entry.path().lexically_relative(folder)] = entry.is_regular_file() ? text_of(entry.path()) : "";
  return files;
}

/// Files of these names must have the same bytes in both folders.
inline void check_same_files(const fs::path& a, const fs::path& b, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    INFO(name);
    CHECK((text_of(a / name) == text_of(b / name)));
  }
}

/// Standard error of a command that must be refused and leave the folder as it was, but for a run's lock,
/// which names its last holder.
inline std::string refused(const Scratch& folder, const std::string& arguments,
                           const std::string& environment = "") {
  const auto files = [&] {
    auto all = files_in(folder.path);
    std::erase_if(all, [](const auto& file) { return file.first.ends_with("/lock"); });
    return all;
  };
  const auto before = files();
  const std::string said = refused_by(arguments, folder.path, environment);
  CHECK((files() == before));
  return said;
}

/// Standard error of a run of e.yaml that must be refused, as a check must be with the same words.
inline std::string refused_alike(const Scratch& folder, const std::string& options = "") {
  const std::string said = refused(folder, "run e.yaml --out out " + options);
  CHECK(refused(folder, "check e.yaml " + options) == said);
  return said;
}

/// What was said must be one line: an error that begins so.
inline void check_error(const std::string& said, const std::string& begin) {
  CHECK_THAT(said, StartsWith("error: " + begin));
  CHECK(std::count(said.begin(), said.end(), '\n') == 1);
}

/// Standard error of a run of this experiment, which must be refused.
inline std::string said_of(const std::string& experiment, const std::string& options = "") {
  return refused(Scratch(experiment), "run e.yaml --out out " + options);
}

/// Standard error of a quiet run that has not converged: a line for each such method.
inline const std::string shortfalls = "(error: [^\n]+; level [0-9] [^\n]+\n)+";

/// Arguments of a command, and how its refusal begins after "error: ".
using Refusals = std::vector<std::pair<std::string, std::string>>;

inline void check_refusals(const Scratch& folder, const std::string& command, const Refusals& refusals) {
  for (const auto& [arguments, refusal] : refusals)
    check_error(refused(folder, command + arguments), refusal);
}

/// How a method and its levels ended, as "failed: converged failed".
inline std::string outcome_of_method(const nlohmann::json& method) {
  std::string all = method.at("status").get<std::string>() + ":";
  for (const nlohmann::json& level : method.at("levels")) all += " " + level.at("status").get<std::string>();
  return all;
}
