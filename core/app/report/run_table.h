#pragma once

#include "core/app/files/json_file.h"
#include "core/app/report/run_collection.h"

namespace drape {

/// A number, or null.
Json json_of(const OptionalNumber& number);

/// One method of one run, its cells by the names of the columns: numbers, words, or null if not
/// known. A run without results is one row.
using TableRow = Json;

/// A method's row, without what tells the runs apart.
TableRow row_of(const RunData& run, const MethodRecord& method);

/// Columns of cost and quality of a method's final state and of its preview, the last state of its coarsest
/// level: those that every run has, then the errors that are measured.
std::vector<std::string> summary_quantities(const std::vector<ErrorMeasure>& measures);

/// Rows and all their columns, in order: what tells the runs apart, the keys that a sweep varies and the seed
/// among it; what every run has; the summary columns of the runs' metrics, errors and previews; the metrics'
/// other values; the message.
struct RunTable {
  std::vector<std::string> columns;
  std::vector<std::string> keys;      ///< those of the columns that a sweep varies
  std::vector<std::string> in_files;  ///< columns that Markdown leaves out unless they are asked for
  std::vector<TableRow> rows;
  bool has_results = false;  ///< of any run: else it is not known which metrics there would be

  bool all_pass() const;
};

/// One row per method and run. The status of a run without results is `refused` before any computation,
/// `timeout` at the time limit, `crash` by a signal, otherwise `failed` or its status. A row passes with the
/// expected status and message, finite energies and no intersection.
RunTable table_of(const RunCollection& collection);

/// A row for each method of each variation: what its rows share, the number of `starts`, how many `converged`
/// and of how many it was the `reference`, and for each number {median, low, high, count} over those that
/// converged. `best` names the columns that bold_text is about.
std::vector<TableRow> summary_of(const RunTable& table, const std::vector<DeclaredMetric>& metrics);

/// The table of a page: columns, rows, the units of the varied keys and of metrics, and the summary.
Json table_json(const RunCollection& collection);

/// What it means that a value is bold, for whoever reads a page or a table.
inline constexpr const char* bold_text =
    "Bold: over at least two starts, the whole range is better than that of every other row of the same "
    "physics.";

/// For comparing values: the lower, the better. Where lower is better, the value nearer to zero is, because a
/// difference of energies may be negative; where neither is, a larger one counts as worse.
double rank_of(Better better, double value);

/// The worst of a state metric's values over a method's levels: where neither direction is better, the
/// largest.
OptionalNumber worst_over_levels(const MetricColumn& column, const MethodRecord& method);

enum class TableFormat { markdown, csv, json };

/// A table of the chosen columns, by default of all non-empty ones, for Markdown without `in_files`. Throws
/// std::runtime_error for an unknown column, with the nearest name.
std::string table_text(const RunTable& table, std::vector<std::string> columns, TableFormat format);

/// The methods of a run beside each other, for a terminal: cost and errors of previews and ends.
std::string methods_text(const RunTable& table);

/// Three significant digits ("403", "0.0213", "7.21e4"), or a dash if absent.
std::string number_text(const OptionalNumber& value);

/// The text for a CSV file: one that a spreadsheet would compute, as "=1+1", gets an apostrophe in front,
/// which it takes for a mark of texts. Numbers stay.
std::string uncomputed(std::string text);

}  // namespace drape
