#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/app/experiment/error_measures.h"
#include "core/app/files/iterations_file.h"
#include "core/app/files/optional_number.h"
#include "core/kernel/interfaces/solver.h"

namespace drape {

/// Numbers by name, in file order.
using NamedNumbers = std::vector<std::pair<std::string, OptionalNumber>>;

/// The known values of metrics or errors, by name.
struct Values : std::map<std::string, double> {
  OptionalNumber of(const std::string& name) const {
    const auto found = find(name);
    return found == end() ? OptionalNumber() : found->second;
  }
  void set(const std::string& name, const OptionalNumber& value) {
    if (value) insert_or_assign(name, *value);
  }
};

/// One level of one method, as results.json has it (SI units).
struct LevelRecord {
  int level = 0;
  std::string status, message;
  OptionalNumber vertices, triangles, steps, iterations, seconds, flops;
  bool from_initial_state = false;          ///< earlier levels do not contribute
  OptionalNumber energy, energy_on_finest;  ///< from the potentials' origin [J]
  OptionalNumber energy_released;           ///< of the finest level, since the scene's start [J]
  OptionalNumber decrement, force_residual, intersections, smallest_gap;
  NamedNumbers seconds_by_phase, energy_parts;
  Values metrics;    ///< of state metrics, by column
  std::string mesh;  ///< relative to the run's folder; may be empty
};

/// A number that results.json has of every level, under the name that it has there, in tables, in comparisons
/// and in Python.
struct LevelQuantity {
  const char* name;
  OptionalNumber LevelRecord::*member;
  const char* title;   ///< for the head of a table, with the unit
  bool count = false;  ///< shown as a whole number
};
inline constexpr LevelQuantity level_quantities[] = {
    {"vertices", &LevelRecord::vertices, "vertices", true},
    {"triangles", &LevelRecord::triangles, "triangles", true},
    {"steps", &LevelRecord::steps, "steps", true},
    {"iterations", &LevelRecord::iterations, "Newton iterations", true},
    {"seconds", &LevelRecord::seconds, "time [s]"},
    {"flops", &LevelRecord::flops, "flops"},
    {"energy", &LevelRecord::energy, "energy [J]"},
    {"energy_on_finest", &LevelRecord::energy_on_finest, "energy on finest [J]"},
    {"energy_released", &LevelRecord::energy_released, "energy released [J]"},
    {"force_residual", &LevelRecord::force_residual, "force residual"},
    {"decrement", &LevelRecord::decrement, "decrement [m/s]"},
    {"intersections", &LevelRecord::intersections, "intersections", true},
    {"smallest_gap", &LevelRecord::smallest_gap, "smallest gap [m]"}};
/// The quantity of that name, which must be one of them.
const LevelQuantity& level_quantity(std::string_view name);

/// Pair metrics of a coarse state, prolonged, against a finer one.
struct ConsistencyRecord {
  int coarse = 0, fine = 0;
  Values metrics;      ///< by column
  Values of_start;     ///< the same for the scene's initial state in place of the coarse one
  std::string fields;  ///< relative to the run's folder; may be empty
};

struct MethodRecord {
  std::string name, status;
  std::string solver;  ///< its type: a method is named in the experiment
  OptionalNumber seconds, peak_memory_bytes;
  OptionalNumber step_size;         ///< h of the first implicit step, and of the static form's decrement [s]
  std::vector<LevelRecord> levels;  ///< coarse to fine
  std::vector<ConsistencyRecord> consistency;

  /// Cost of the last state: the sum of the known values over the levels that it builds on.
  OptionalNumber cost(OptionalNumber LevelRecord::*member) const;
  /// The coarsest level that the last state builds on.
  int first_level() const;
  const LevelRecord* level(int index) const;
  const ConsistencyRecord* pair(int coarse, int fine) const;
};

/// All rows of one level of one method, in order.
struct IterationSeries {
  std::string method;
  int level = 0;
  std::vector<RecordedIteration> rows;
};

/// One row of errors.csv: a state's cost, and its error against each target in each measure.
struct ErrorRow {
  std::array<OptionalNumber, error_costs.size()> cost;
  std::array<Values, error_targets.size()> error;  ///< by measure
};

struct ErrorSeries {
  std::string method;
  int level = 0;
  std::vector<ErrorRow> rows;
};

/// Everything a finished or interrupted run has written, except meshes.
struct RunData {
  std::filesystem::path folder;
  std::string experiment, version, cpu, configuration;
  bool complete = false;
  OptionalNumber threads;
  std::vector<std::string> obstacles;       ///< meshes, relative to the folder
  std::vector<std::string> obstacle_names;  ///< of each of them; empty for an obstacle without a name
  std::vector<DeclaredMetric> metrics;
  std::vector<ErrorMeasure> error_measures;
  std::vector<MethodRecord> methods;
  std::vector<IterationSeries> iterations;  ///< in the order of methods, coarse to fine
  std::vector<ErrorSeries> errors;          ///< likewise
  std::string reference;                    ///< method or file of the state that errors are measured against
  bool reference_is_file = false;

  /// Whether the run had contact: otherwise it has no gaps and intersections.
  bool has_contact() const;
  /// Declared columns that are at least so widely shown, in order.
  std::vector<MetricColumn> columns(MetricScope scope, Shown least) const {
    return columns_of(metrics, scope, least);
  }
  int finest_level() const;  ///< over all methods; -1 without levels
};

/// Reads results.json (required), iterations.csv, errors.csv and config.yaml (optional). Null values are
/// absent. Throws std::runtime_error with one line if results.json is missing or is not JSON.
RunData read_run(const std::filesystem::path& folder);

}  // namespace drape
