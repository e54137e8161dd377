#pragma once

#include <functional>

#include "core/app/experiment/experiment.h"
#include "core/app/files/json_file.h"
#include "core/kernel/plugin/declaration.h"

namespace drape {

/// The expected status of a run: a case that is made to fail passes if it fails as expected.
struct Expectation {
  std::string status = "converged";
  std::string message;  ///< a part of the message
  static void declare(Declaration<Expectation>& d);
};

/// A sweep file: variations of one experiment, `base`, or of each of several. `ablation` is a list of
/// variations, or a map with a `grid`.
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

/// One run: a resolved experiment.
struct SweepRun {
  std::string name;  ///< of the variation, after its experiment's if there are several
  Json settings;     ///< the run's values of all keys that variations set, by path
  int seed = 1;
  std::string folder;  ///< "runs/NAME/seed_1", unique in the sweep
  std::string config;  ///< the resolved experiment as YAML, with the chosen methods only
  int levels = 1;
  double vertices = 0;  ///< estimate for the finest level
  Expectation expect;
};

/// A validated sweep file.
struct Sweep {
  SweepParameters parameters;
  std::filesystem::path file;
  std::vector<SweepRun> runs;  ///< the seeds of the first variation, then of the next
};

/// How a sweep's runs are executed, here or on a cluster.
struct SweepOptions {
  int workers = 0;      ///< concurrent runs; 0, on a cluster: no limit
  int threads = 0;      ///< of each run
  double memory = 0;    ///< [bytes] here of all runs together, on a cluster of each; 0: by estimate
  bool report = false;  ///< write each run's report
  bool quiet = false;   ///< say nothing of runs that end well
  bool retry_failed = false;
  std::vector<std::string> sbatch;                    ///< further options, as "--partition=long"
  std::function<bool()> stop = [] { return false; };  ///< polled
};

/// Reads and validates a sweep with every experiment in it; empty, with every error appended, if it is not
/// valid. Experiments get at most `most_levels` levels.
std::optional<Sweep> read_sweep(const std::filesystem::path& file, const Registry& registry,
                                ConfigErrors& errors, std::optional<int> most_levels = std::nullopt);

/// Validates a sweep whose file has been read already.
std::optional<Sweep> read_sweep(ConfigNode source, const Registry& registry, ConfigErrors& errors,
                                std::optional<int> most_levels = std::nullopt);

/// The schema of sweeps, `ablation` included, for `drape describe` and as JSON Schema for editors.
std::string describe_sweep();
std::string describe_sweep_markdown();
Json sweep_json_schema();

}  // namespace drape
