#include <algorithm>
#include <array>
#include <boost/algorithm/string/replace.hpp>
#include <cmath>
#include <stdexcept>

#include "core/app/files/json_file.h"
#include "core/app/report/run_table.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/config_node.h"

namespace drape {

namespace {

std::string cell_text(const Json& value, bool rounded) {
  if (value.is_null()) return "";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "NO";
  if (value.is_string()) return value.get<std::string>();
  return rounded ? number_text(value.get<double>()) : ConfigNode::of(value.get<double>()).scalar;
}

std::string markdown_cell(const Json& value) {
  const bool counted = value.is_number() && value.get<double>() == std::floor(value.get<double>()) &&
                       std::abs(value.get<double>()) < 1e9;
  return boost::replace_all_copy(boost::replace_all_copy(cell_text(value, !counted), "|", "\\|"), "\n", "; ");
}

std::string csv_cell(const Json& value) {
  std::string text = cell_text(value, false);
  if (value.is_string()) text = uncomputed(std::move(text));
  return text.find_first_of(",\"\r\n") == std::string::npos
             ? text
             : "\"" + boost::replace_all_copy(text, "\"", "\"\"") + "\"";
}

/// Whether the column has words: it is aligned to the left.
bool is_text(const RunTable& table, const std::string& column) {
  return std::any_of(table.rows.begin(), table.rows.end(), [&](const TableRow& row) {
    const Json& value = member_of(row, column);
    return value.is_string() || value.is_boolean();
  });
}

std::vector<std::string> chosen_columns(const RunTable& table, const std::vector<std::string>& chosen,
                                        TableFormat format) {
  const std::vector<std::string>& known = table.columns;
  for (const std::string& column : chosen) {
    if (is_one_of(column, known) || !table.has_results) continue;  // a metric might declare it
    throw std::runtime_error("there is no column \"" + excerpt(column) + "\"; " +
                             did_you_mean(column, known, "the columns are " + joined(known)));
  }
  if (!chosen.empty()) return chosen;
  std::vector<std::string> columns = known;
  std::erase_if(columns, [&](const std::string& column) {
    const auto is_empty = [&](const TableRow& row) {
      return cell_text(member_of(row, column), true).empty();
    };
    return (format == TableFormat::markdown && is_one_of(column, table.in_files)) ||
           std::ranges::all_of(table.rows, is_empty);
  });
  return columns;
}

}  // namespace

std::string table_text(const RunTable& table, std::vector<std::string> columns, TableFormat format) {
  columns = chosen_columns(table, columns, format);
  if (format == TableFormat::json) {
    Json chosen = Json::array();
    for (const TableRow& row : table.rows) {
      Json& one = chosen.emplace_back(Json::object());
      for (const std::string& column : columns) one[column] = member_of(row, column);
    }
    return ascii_json_text(chosen, 1) + "\n";
  }
  const bool csv = format == TableFormat::csv;
  const auto line = [&](const auto& cell_of) {
    std::string text;
    for (const std::string& column : columns)
      text += (csv ? (&column == &columns[0] ? "" : ",") : "| ") + cell_of(column) + (csv ? "" : " ");
    return text + (csv ? "\n" : "|\n");
  };
  std::string text = line([&](const std::string& column) { return csv ? csv_cell(column) : column; });
  if (!csv)
    text +=
        line([&](const std::string& column) { return std::string(is_text(table, column) ? "---" : "---:"); });
  for (const TableRow& row : table.rows)
    text += line([&](const std::string& column) {
      const Json& value = member_of(row, column);
      return csv ? csv_cell(value) : markdown_cell(value);
    });
  return text;
}

std::string methods_text(const RunTable& table) {
  std::vector<std::string> columns = {"method",     "status",      "preview_seconds", "preview_rms",
                                      "seconds",    "cpu_seconds", "iterations",      "error_rms",
                                      "energy_gap", "machine"};
  const bool busy = std::ranges::any_of(
      table.rows, [](const TableRow& row) { return member_of(row, "machine") == "busy"; });
  std::erase_if(columns, [&](const std::string& column) {
    return !is_one_of(column, table.columns) || (column == "machine" && !busy);
  });
  std::vector<std::vector<std::string>> lines = {columns};
  for (const TableRow& row : table.rows) {
    std::vector<std::string>& cells = lines.emplace_back();
    for (const std::string& column : columns) {
      const Json& value = member_of(row, column);
      cells.push_back(value.is_null() ? number_text({}) : cell_text(value, true));
    }
  }
  return text_table(lines);
}

std::string uncomputed(std::string text) {
  const std::array marks = {"=", "+", "-", "@", "\t", "\r", "\uff1d", "\uff0b", "\uff0d", "\uff20"};
  const bool is_computed = std::ranges::any_of(marks, [&](auto mark) { return text.starts_with(mark); });
  if (is_computed && !parse_number(text)) text.insert(0, "'");
  return text;
}

std::string number_text(const OptionalNumber& value) {
  if (!value) return "–";
  if (*value == 0) return "0";
  const std::string text = scientific_text(*value, 2);
  const std::size_t e = text.find('e');
  const int exponent = std::stoi(text.substr(e + 1));
  if (exponent < -3 || exponent > 3) return text.substr(0, e) + "e" + std::to_string(exponent);
  return fixed_text(parse_number(text).value(), std::max(0, 2 - exponent));
}

}  // namespace drape
