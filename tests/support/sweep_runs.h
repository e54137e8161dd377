#pragma once

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/command.h"

/// The beginning of a sweep of e.yaml on its coarsest level, by Newton's method.
inline const std::string coarsest_by_newton = "name: s\nbase: e.yaml\nset: {levels: 1}\nmethods: [newton]\n";

/// The runs of a sweep's folder, as its sweep.json lists them.
inline nlohmann::json runs_of(const std::filesystem::path& sweep) {
  return json_in(sweep / "sweep.json")["runs"];
}

/// A folder with a sweep of the small experiment: coarsest_by_newton and what follows it.
struct SmallSweep : Scratch {
  explicit SmallSweep(const std::string& rest = "") : Scratch(small_experiment()) {
    write("s.yaml", coarsest_by_newton + rest);
  }
  /// Runs what is missing in the folder "out".
  Ended sweep(int exit_code = 0, const std::string& options = "") const {
    return drape_ends("sweep s.yaml --out out" + options, *this, exit_code);
  }
  nlohmann::json runs() const { return runs_of(path / "out"); }
};

/// What a sweep computed: every level's mesh and every energy, by file and method.
inline std::map<std::string, std::string> outcome_of(const std::filesystem::path& sweep) {
  std::map<std::string, std::string> all;
  for (const nlohmann::json& run : runs_of(sweep)) {
    const std::string folder = run["folder"];
    for (const auto& entry : std::filesystem::directory_iterator(sweep / folder / "levels"))
      if (entry.path().extension() == ".ply")
        all[folder + "/" + entry.path().filename().string()] = text_of(entry.path());
    const nlohmann::json results = json_in(sweep / folder / "results.json");
    for (const auto& [name, method] : results["methods"].items())
      for (const nlohmann::json& level : method["levels"])
        all[folder + ":" + name] += level["energy"].dump() + " " + level["iterations"].dump() + " ";
  }
  return all;
}

inline int count_of(const nlohmann::json& runs, const std::string& status) {
  return int(std::count_if(runs.begin(), runs.end(),
                           [&](const nlohmann::json& run) { return run.at("status") == status; }));
}

/// Waits until so many runs of a sweep that is at work have that status.
inline void wait_for(Command& command, const std::filesystem::path& sweep, const std::string& status,
                     int runs) {
  command.wait_until(sweep.string() + " has " + std::to_string(runs) + " runs that are " + status, [&] {
    return std::filesystem::exists(sweep / "sweep.json") && count_of(runs_of(sweep), status) >= runs;
  });
}

/// Puts a copy of the program into the folder, as bin/drape, for replace_program to replace.
inline void copy_program(const Scratch& folder) {
  std::filesystem::create_directory(folder / "bin");
  for (const char* name : {"bin/drape", "bin/new"}) std::filesystem::copy_file(drape_command, folder / name);
  std::filesystem::create_directory_symlink(std::filesystem::path(drape_command).parent_path() / "../lib",
                                            folder / "lib");
}

inline void replace_program(const Scratch& folder) {
  std::filesystem::rename(folder / "bin/new", folder / "bin/drape");
}
