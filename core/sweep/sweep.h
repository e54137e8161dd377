#pragma once

#include <nlohmann/json.hpp>

#include "core/experiment/experiment.h"

namespace drape {

/// How a run is to end: a case made to fail passes when it fails as it should, saying why.
struct Expectation {
  std::string outcome = "converged";
  std::string message;  ///< a part of what it says
  static void declare(Declaration<Expectation>& d);
};

/// A named variation of a sweep's experiments.
struct VariationParameters {
  std::string name;
  ConfigNode set;
  std::optional<int> levels;
  std::vector<std::string> methods;
  Expectation expect;
  static void declare(Declaration<VariationParameters>& d);
};

/// A whole sweep file: the variations of one experiment, `base`, or of each of several. `ablation` is a list
/// of variations, or a map with a `grid`.
struct SweepParameters {
  std::string name;
  std::string description;
  std::string base;
  std::vector<std::string> experiments;
  ConfigNode set;
  std::vector<int> seeds;
  std::optional<int> repeats;
  std::vector<std::string> methods;
  int threads = 1;
  std::optional<double> time_limit;
  ConfigNode ablation;
  static void declare(Declaration<SweepParameters>& d);
};

/// One experiment to be run, with everything decided.
struct SweepRun {
  std::string name;                 ///< of the variation, behind its experiment's where there are several
  nlohmann::ordered_json settings;  ///< what the variation sets, by path of keys
  int seed = 1;
  std::string folder;  ///< "runs/NAME/seed_1", unique in the sweep
  std::string config;  ///< the resolved experiment as YAML, with the chosen methods alone
  int levels = 1;
  double vertices = 0;  ///< about how many the finest level has
  Expectation expect;
};

/// A sweep file that has been read, every variation of it checked.
struct Sweep {
  SweepParameters parameters;
  std::filesystem::path file;
  std::vector<SweepRun> runs;  ///< the seeds of the first variation, then of the next
};

/// Reads a sweep and every experiment in it, collecting all that is wrong; empty if anything is. Experiments
/// of more than `most_levels` levels are made to have so many.
std::optional<Sweep> read_sweep(const std::filesystem::path& file, const Registry& registry,
                                ConfigErrors& errors, std::optional<int> most_levels = std::nullopt);

/// The schema of sweeps for `drape describe`, and as JSON for editors, what `ablation` takes included.
std::string describe_sweep();
std::string describe_sweep_markdown();
nlohmann::ordered_json sweep_json_schema();

}  // namespace drape
