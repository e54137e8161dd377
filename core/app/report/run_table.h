#pragma once

#include <nlohmann/json.hpp>

#include "core/app/report/run_collection.h"

namespace drape {

/// One method of one run, its cells by the names of the columns: numbers, words, or null if not
/// known. A run without results is one row.
using TableRow = nlohmann::ordered_json;

/// One row per method and run. The outcome of a run without results is `refused` before any computation,
/// `timeout` at the time limit, `crash` by a signal, otherwise `failed` or its status. A row passes with the
/// expected outcome and message, finite energies and no intersection.
std::vector<TableRow> table_rows(const RunCollection& collection);

bool all_pass(const std::vector<TableRow>& rows);

/// All columns, in order.
std::vector<std::string> table_columns();

enum class TableFormat { markdown, csv, json };

/// A table of the chosen columns, by default of all non-empty ones. Throws std::runtime_error for an unknown
/// column, with its new or the nearest name.
std::string table_text(const std::vector<TableRow>& rows, std::vector<std::string> columns,
                       TableFormat format);

}  // namespace drape
