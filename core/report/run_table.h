#pragma once

#include <nlohmann/json.hpp>

#include "core/report/run_collection.h"

namespace drape {

/// One method of one run, its cells by the names of the columns: numbers, words, or null for what is not
/// known. A run without results is one row.
using TableRow = nlohmann::ordered_json;

/// A run's outcome beside those of its levels: `refused` before anything was computed, `hang` when it was
/// ended for its time, `crash` by a signal, else `failed` or as its status says. A row passes when it has
/// ended as its run is expected to, for the reason expected, every figure of its energy finite and no
/// intersection anywhere.
std::vector<TableRow> table_rows(const RunCollection& collection);

bool all_pass(const std::vector<TableRow>& rows);

/// What rows can have, in order.
std::vector<std::string> table_columns();

enum class TableFormat { markdown, csv, json };

/// The chosen columns; without a choice all that any row has. Throws std::runtime_error for one that there is
/// not, naming the nearest.
std::string table_text(const std::vector<TableRow>& rows, std::vector<std::string> columns,
                       TableFormat format);

}  // namespace drape
