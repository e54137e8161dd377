#include "core/app/experiment/describe.h"

#include <cmath>

#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {
namespace {

struct Row {
  int depth = 0;
  std::string path;  ///< "section.name"
  const Parameter* parameter = nullptr;
  std::string type, initial, range, link;
};

ConfigNode defaults_of(const Schema& schema) { return schema.write(schema.fresh().get()); }

std::string range_text(const Parameter& p) {
  std::vector<std::string> parts;
  const auto bound = [&](const char* sign, double value) {
    if (std::isfinite(value)) parts.push_back(sign + exact_text(value));
  };
  if (std::isfinite(p.minimum) && std::isfinite(p.maximum) && !p.open_minimum && !p.open_maximum) {
    parts.push_back(p.minimum == -p.maximum ? "±" + exact_text(p.maximum)
                                            : exact_text(p.minimum) + " to " + exact_text(p.maximum));
  } else {
    bound(p.open_minimum ? "> " : ">= ", p.minimum);
    bound(p.open_maximum ? "< " : "<= ", p.maximum);
  }
  if (!p.choices.empty()) parts.push_back(joined(p.choices));
  return joined(parts);
}

std::string type_text(const Parameter& p) {
  const bool list = p.type.is_list();
  std::string type = p.type.text();
  if (!p.plugin_kind.empty()) type = (list ? "list of plugins, " : "plugin, ") + p.plugin_kind;
  if (list && p.type.size) type = std::to_string(p.type.size) + type.substr(std::string("list of").size());
  return type + (p.type.nullable ? " or null" : "");
}

/// Every parameter in order; a section is followed by its parameters, unless it is the shared one.
void collect(const Schema& schema, const ConfigNode& defaults, int depth, const std::string& prefix,
             const ReferencePage* page, std::vector<Row>& rows) {
  for (const Parameter& p : schema.parameters) {
    const ConfigNode* initial = defaults.find(p.name);
    Row row{depth, prefix + p.name, &p, type_text(p), "", range_text(p), ""};
    const bool is_section = p.type.is_one(ValueKind::section);
    const bool is_shared = page && is_section && p.section->name == page->shared.name &&
                           initial->one_line() == defaults_of(page->shared).one_line();
    if (is_shared) row.link = page->link;
    if (p.required)
      row.initial = "required";
    else if (!is_section && initial)
      row.initial = initial->one_line();
    rows.push_back(row);
    if (is_shared) continue;
    if (is_section)
      collect(*p.section, *initial, depth + 1, row.path + ".", page, rows);
    else if (p.section)
      collect(*p.section, defaults_of(*p.section), depth + 1, row.path + "[].", page, rows);
  }
}

std::vector<Row> rows_of(const Schema& schema, const ReferencePage* page = nullptr) {
  std::vector<Row> rows;
  collect(schema, defaults_of(schema), 0, "", page, rows);
  return rows;
}

std::string unit_of(const Parameter& p) { return p.unit == "1" ? "" : p.unit; }

std::string description_of(const Parameter& p) {
  return p.description + (p.from_experiment ? "; a key of the experiment" : "");
}

std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? "\\|" : c == '\n' ? " " : std::string(1, c);
  return escaped + "|";
}

/// What a parameter may be: "number [m], > 0". That null is allowed is told by a default of null.
std::string value_of(const Row& row) {
  const std::string unit = unit_of(*row.parameter);
  const std::string type = row.initial == "null" ? row.type.substr(0, row.type.find(" or null")) : row.type;
  return type + (unit.empty() ? "" : " [" + unit + "]") +
         (row.range.empty() ? "" : (row.parameter->choices.empty() ? ", " : ": ") + row.range);
}

/// The cells of a row after its path.
std::string cells_of(const Row& row) {
  const Parameter& p = *row.parameter;
  const std::string initial = row.initial.empty() || p.required ? row.initial : "`" + row.initial + "`";
  std::string meaning = description_of(p) + (row.link.empty() ? "" : "; see " + row.link);
  if (!p.source.empty()) meaning += (meaning.empty() ? "[" : " [") + p.source + "]";
  return cell(value_of(row)) + cell(initial) + cell(meaning);
}

/// "`obstacles[]` of `ipc`"; nothing at the top of an experiment.
std::string place_of(const std::string& section, const std::string& plugin) {
  std::string place = section.empty() ? "" : "`" + section.substr(0, section.size() - 1) + "`";
  if (!plugin.empty()) place += (place.empty() ? "`" : " of `") + plugin + "`";
  return place;
}

}  // namespace

std::string describe(const Schema& schema) {
  std::vector<std::vector<std::string>> table = {{"name", "type", "default", "unit", "range"}};
  const std::vector<Row> rows = rows_of(schema);
  for (const Row& row : rows)
    table.push_back({std::string(2 * size_t(row.depth), ' ') + row.parameter->name, row.type, row.initial,
                     unit_of(*row.parameter), row.range});
  if (rows.empty()) return "  no parameters\n";
  const std::vector<std::string> lines = split(text_table(table), '\n');
  std::string text;
  for (size_t i = 0; i < table.size(); ++i) {
    text += "  " + lines[i] + "\n";
    if (i == 0) continue;
    const Parameter& p = *rows[i - 1].parameter;
    std::string note = description_of(p);
    if (!p.source.empty()) note += (note.empty() ? "[" : " [") + p.source + "]";
    if (!note.empty()) text += "      " + std::string(2 * size_t(rows[i - 1].depth), ' ') + note + "\n";
  }
  return text;
}

std::string describe(const RegistryEntry& entry) {
  return entry.kind + " " + entry.name + ": " + entry.summary + "\nfrom " + entry.library + "\n\n" +
         describe(entry.schema) + (entry.details.empty() ? "" : "\n" + entry.details);
}

std::string describe_markdown(const Schema& schema, ReferencePage* page, const std::string& plugin) {
  const std::vector<Row> rows = rows_of(schema, page);
  ReferencePage alone;
  if (!page) page = &alone;
  std::vector<std::string> cells, place;  // of each row
  for (const Row& row : rows) {
    cells.push_back(cells_of(row));
    place.push_back(place_of(row.path.substr(0, row.path.size() - row.parameter->name.size()), plugin));
  }
  // The place where the page has described a row, or nothing.
  const auto known = [&](std::size_t k) {
    const auto found = page->places.find(rows[k].parameter->name + cells[k]);
    return found == page->places.end() || !rows[k].link.empty() ? "" : found->second;
  };
  std::string text = "|key|value|default|meaning|\n|---|---|---|---|\n";
  for (std::size_t i = 0, end; i < rows.size(); i = end) {
    const std::string elsewhere = known(i);
    for (end = i + 1; end < rows.size() && place[end] == place[i] && known(end) == elsewhere;) ++end;
    const bool refer =
        !elsewhere.empty() && end - i >= 3;  // fewer keys are read more easily where they stand
    if (!refer)
      for (end = i + 1; end < rows.size() && place[end] == place[i] && cells[end] == cells[i];) ++end;
    std::string keys = "`" + rows[i].path + "`";
    for (std::size_t k = i + 1; k < end; ++k) keys += ", `" + rows[k].parameter->name + "`";
    text += "|" + cell(keys) + (refer ? cell("as of " + elsewhere) + "||" : cells[i]) + "\n";
    if (!refer)
      for (std::size_t k = i; k < end; ++k) page->places[rows[k].parameter->name + cells[k]] = place[k];
  }
  return text;
}

std::string describe_markdown(const RegistryEntry& entry, ReferencePage& page) {
  return "### " + entry.kind + " `" + entry.name + "`\n\n" + entry.summary + "\n\n" +
         describe_markdown(entry.schema, &page, entry.name);
}

}  // namespace drape
