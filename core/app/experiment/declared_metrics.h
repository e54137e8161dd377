#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/app/files/json_file.h"
#include "core/kernel/interfaces/metric.h"
#include "core/kernel/plugin/config_node.h"

namespace drape {

class Registry;

/// A metric of a run, as results.json has it under "metrics".
struct DeclaredMetric {
  std::string name;
  MetricScope scope = MetricScope::pair;
  MetricDeclaration declaration;
};

/// The metrics of an experiment that names none: all that need no parameter.
std::vector<std::string> default_metrics(const Registry& registry);

/// The declarations of an experiment's metrics, each column with a label. Of two metrics with one name, the
/// first counts.
std::vector<DeclaredMetric> declared_metrics(
    const std::vector<std::pair<std::string, std::shared_ptr<Metric>>>& metrics);

/// Appends an error for every value of a metric whose name is empty, declared twice, taken by results.json
/// itself or within another value's place there, for every error whose name errors.csv cannot have, and for
/// every field that another metric declares too.
void check_declarations(const std::vector<DeclaredMetric>& metrics, const Location& where,
                        ConfigErrors& errors);

/// The declarations for results.json: an object by the metrics' names.
Json json_of(const std::vector<DeclaredMetric>& metrics);
/// Reads them again. Entries of another form, as of an edited file, are skipped or have default members.
std::vector<DeclaredMetric> declared_metrics(const Json& json);

/// Columns of a scope that are shown at least as widely as `least`, in the order of declaration; each name
/// once.
std::vector<MetricColumn> columns_of(const std::vector<DeclaredMetric>& metrics, MetricScope scope,
                                     Shown least);

/// Adds the metrics and columns that are not in `all` yet, as of another run.
void merge(std::vector<DeclaredMetric>& all, const std::vector<DeclaredMetric>& more);

/// A measure of a state's error (docs/theory/errors.md); errors.csv has a column of it for every target.
struct ErrorMeasure {
  std::string name;   ///< in errors.csv, after the target's
  std::string label;  ///< as MetricColumn::label, with the unit
  ErrorUse use = ErrorUse::plots;
  std::string value;              ///< the metrics' value that it is of; empty for energy_gap
  Better better = Better::lower;  ///< of that value: if higher, the error is 1 − value
};

/// The energy above the target's, relative to ErrorTarget::scale; the run itself measures it.
inline constexpr const char* energy_gap = "energy_gap";

/// The measures that metrics declare, those that rank first, and the energy gap, last.
std::vector<ErrorMeasure> error_measures(const std::vector<DeclaredMetric>& metrics);

}  // namespace drape
