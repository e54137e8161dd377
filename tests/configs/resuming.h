#pragma once

#include "core/app/files/csv.h"
#include "core/app/run/runner.h"
#include "core/app/run/saved_run.h"
#include "tests/configs/runs.h"
#include "tests/support/contact_scenes.h"

/// Two small sheets, on three levels.
inline void write_sheets(const Scratch& folder) {
  write_sheets(folder, 6);
  folder.write("e.yaml", replaced(text_of(folder / "e.yaml"), "levels: 2", "levels: 3"));
}

/// Without what a clock or the machine says.
inline nlohmann::json timeless(nlohmann::json json) {
  if (json.is_object())
    for (const char* key : {"seconds", "cpu_seconds", "seconds_by_phase", "load_before", "load_after",
                            "ended", "peak_memory_bytes"})
      json.erase(key);
  if (json.is_structured())
    for (auto& item : json.items()) item.value() = timeless(item.value());
  return json;
}

/// All that two equal runs have in common, by file.
inline std::map<std::string, std::string> outcome_of(const fs::path& run) {
  auto all = files_in(run);
  std::erase_if(all, [](const auto& file) {
    const std::string part = file.first.substr(0, file.first.find('/') + 1);
    return part != "levels/" && part != "snapshots/" && part != "fields/" && part != "obstacles/";
  });
  all["results.json"] = timeless(results_in(run)).dump(1);
  for (const char* name : {"iterations.csv", "errors.csv"}) {
    const drape::Csv rows(run / name);
    REQUIRE(rows.size() > 0);
    for (const std::string& column : rows.names())
      for (std::size_t k = 0; k < rows.size() && column != "seconds"; ++k)
        all[name] += column + " " + rows.text(k, column) + "\n";
  }
  return all;
}

inline void check_equal(const fs::path& run, const fs::path& expected) {
  const auto a = outcome_of(run), b = outcome_of(expected);
  REQUIRE(a.size() == b.size());
  for (const auto& [name, bytes] : b) {
    INFO(name);
    REQUIRE(a.count(name) == 1);
    if (name == "results.json")
      CHECK(a.at(name) == bytes);
    else
      CHECK((a.at(name) == bytes));  // not shown
  }
}

inline drape::RunOptions silent(const fs::path& out) {
  drape::RunOptions options;
  options.out = out;
  options.verbosity = drape::Verbosity::quiet;
  options.report = false;
  return options;
}

/// A run of the sheets into a folder, with a checkpoint at every step.
inline std::string sheets_run(const std::string& out) {
  return "run e.yaml --method all --quiet --no-report --measure --threads 1 --checkpoint 0 --set "
         "newton.max_steps=8 "
         "--set start.translate=[-0.2,-0.2,0.1015] --out " +
         out;
}
inline const std::string go_on = "run --resume out --quiet --no-report --measure --threads 1 --checkpoint 0";

/// Waits until the run has taken that many steps.
inline void wait_for_steps(Command& command, const fs::path& out, int steps) {
  wait_for_lines(command, out / "iterations.csv", steps + 1);
}

/// What a run of the sheets leaves that was interrupted in the middle.
inline void interrupt_sheets(const Scratch& folder) {
  write_sheets(folder);
  DrapeAtWork command(sheets_run("out"), folder);
  wait_for_steps(command, folder / "out", 12);
  REQUIRE(command.ended_by(SIGINT).exit_code == 130);
  REQUIRE_FALSE(drape::is_complete(folder / "out"));
}
