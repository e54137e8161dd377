#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/experiment/error_measures.h"
#include "core/model/solver.h"

namespace drape {

/// A figure of a run, absent when the run did not get that far or did not measure it.
using Figure = std::optional<double>;

/// Figures by name, in the order they were written.
using NamedFigures = std::vector<std::pair<std::string, Figure>>;

/// One level of one method, as results.json has it (SI units).
struct LevelRecord {
  int level = 0;
  std::string status, message;
  Figure vertices, triangles, steps, newton_iterations, seconds, flops;
  bool from_initial_state = false;   ///< begun from the scene's start: what came before is not in it
  Figure energy, energy_on_finest;   ///< [J]
  Figure decrement, force_residual;  ///< [m/s], [1]
  Figure largest_stretch, intersections, smallest_gap;
  Figure contacts;  ///< in the last iteration
  NamedFigures seconds_by_phase, energy_parts;
  std::string mesh;  ///< relative to the run's folder; may be empty
};

/// What one state scores against a finer level's.
struct PairFigures {
  Figure d_H_fit, d_H_ddg, d_K_fit, d_K_ddg;  ///< [1], [1], [1/m²], [1/m²]
  Figure distance_rms;                        ///< in diagonals of the rest shape
  Figure silhouette_overlap;                  ///< [1]; higher is better
  Figure energy_above_end;                    ///< [J]
};

/// Differences of one coarse state, carried up, from one finer state.
struct ConsistencyRecord : PairFigures {
  int coarse = 0, fine = 0;
  PairFigures of_start;  ///< the same of the scene's start in the coarse state's place
  std::string fields;    ///< relative to the run's folder; may be empty
};

struct MethodRecord {
  std::string name, status;
  Figure seconds, peak_memory_bytes;
  Figure step_size;                 ///< h of the first implicit step, and of the static form's decrement [s]
  std::vector<LevelRecord> levels;  ///< coarse to fine
  std::vector<ConsistencyRecord> consistency;

  /// What the last state took: the sum over the levels that it builds on, of those that are known.
  Figure cost(Figure LevelRecord::*member) const;
  const LevelRecord* level(int index) const;
  const ConsistencyRecord* pair(int coarse, int fine) const;
};

/// One row of steps.csv.
struct StepRow {
  Figure seconds, energy, decrement, force_residual, step_length, proxy_energy, step_size;
  Figure contacts, smallest_gap, intersections;
};

/// All rows of one level of one method, in order.
struct IterationSeries {
  std::string method;
  int level = 0;
  std::vector<StepRow> rows;
};

/// The end of an increment of load stepping.
struct ConditionRow {
  Figure time, steps, energy;  ///< pseudo-time; the others as of a level
};

/// All increments of one level of one method, in order.
struct ConditionSeries {
  std::string method;
  int level = 0;
  std::vector<ConditionRow> rows;
};

/// One row of errors.csv: what a state cost, and its error against each target in each measure.
struct ErrorRow {
  std::array<Figure, error_works.size()> work;
  std::array<std::array<Figure, error_measures.size()>, error_targets.size()> error;
};

struct ErrorSeries {
  std::string method;
  int level = 0;
  std::vector<ErrorRow> rows;
};

/// Everything a finished or interrupted run has written, except meshes.
struct RunData {
  std::filesystem::path folder;
  std::string experiment, description, version, cpu, table1_scene, configuration;
  bool complete = false;
  std::string broken_off;  ///< why it was; empty if it was not
  Figure cores, threads, force_tolerance;
  std::vector<std::string> obstacles;  ///< meshes, relative to the folder
  std::vector<MethodRecord> methods;
  std::vector<IterationSeries> iterations;  ///< in the order of methods, coarse to fine
  std::vector<ErrorSeries> errors;          ///< likewise
  std::vector<ConditionSeries> changes;     ///< likewise; none without a schedule
  std::string reference;                    ///< the method, or file, that errors are measured against
  bool reference_is_lowest = false;         ///< that method's was chosen as the lowest in energy
  Figure reference_tolerance;               ///< of the force residual, to which it was solved further

  /// Whether anything was kept apart, so that gaps and intersections mean something.
  bool has_contact() const;
  int coarsest_level() const;              ///< over all methods; -1 without levels
  int finest_level() const;                ///< over all methods; -1 without levels
  std::vector<int> level_indices() const;  ///< of all methods, ascending
  /// (coarse, fine) of all methods, ascending.
  std::vector<std::pair<int, int>> pairs() const;
};

/// Reads results.json (needed), steps.csv and config.yaml (if there). Absent or null values stay absent.
/// Throws std::runtime_error with one line if results.json is missing or is not JSON.
RunData read_run(const std::filesystem::path& folder);

}  // namespace drape
