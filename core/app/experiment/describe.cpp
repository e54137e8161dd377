#include "core/app/experiment/describe.h"

#include <cmath>

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
    if (std::isfinite(value)) parts.push_back(sign + ConfigNode::of(value).scalar);
  };
  bound(p.open_minimum ? "> " : ">= ", p.minimum);
  bound(p.open_maximum ? "< " : "<= ", p.maximum);
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
             const SharedSection* shared, std::vector<Row>& rows) {
  for (const Parameter& p : schema.parameters) {
    const ConfigNode* initial = defaults.find(p.name);
    Row row{depth, prefix + p.name, &p, type_text(p), "", range_text(p), ""};
    const bool is_section = p.type.is_one(ValueKind::section);
    const bool is_shared = shared && is_section && p.section->name == shared->schema.name &&
                           initial->one_line() == defaults_of(shared->schema).one_line();
    if (is_shared) row.link = shared->link;
    if (p.required)
      row.initial = "required";
    else if (!is_section && initial)
      row.initial = initial->one_line();
    rows.push_back(row);
    if (is_shared) continue;
    if (is_section)
      collect(*p.section, *initial, depth + 1, row.path + ".", shared, rows);
    else if (p.section)
      collect(*p.section, defaults_of(*p.section), depth + 1, row.path + "[].", shared, rows);
  }
}

std::vector<Row> rows_of(const Schema& schema, const SharedSection* shared = nullptr) {
  std::vector<Row> rows;
  collect(schema, defaults_of(schema), 0, "", shared, rows);
  return rows;
}

std::string unit_of(const Parameter& p) { return p.unit == "1" ? "" : p.unit; }

std::string description_of(const Parameter& p) {
  return p.description + (p.from_experiment ? "; a key of the experiment" : "");
}

std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? "\\|" : c == '\n' ? " " : std::string(1, c);
  return " " + escaped + " |";
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

std::string describe_markdown(const Schema& schema, const SharedSection* shared) {
  const std::vector<Row> rows = rows_of(schema, shared);
  if (rows.empty()) return "No parameters.\n";
  std::string text =
      "| name | type | default | unit | range | description | source |\n|---|---|---|---|---|---|---|\n";
  for (const Row& row : rows) {
    const Parameter& p = *row.parameter;
    const std::string initial = row.initial.empty() || p.required ? row.initial : "`" + row.initial + "`";
    text += "|" + cell("`" + row.path + "`") + cell(row.type) + cell(initial) + cell(unit_of(p)) +
            cell(row.range) + cell(description_of(p) + (row.link.empty() ? "" : "; see " + row.link)) +
            cell(p.source) + "\n";
  }
  return text;
}

std::string describe_markdown(const RegistryEntry& entry, const SharedSection* shared) {
  return "### " + entry.kind + " `" + entry.name + "`\n\n" + entry.summary + "\n\n" +
         describe_markdown(entry.schema, shared);
}

std::string with_parameters(const std::string& page, const RegistryEntry& entry,
                            const SharedSection* shared) {
  static const std::string heading = "## Parameters\n";
  const std::size_t at = page.find("\n" + heading);
  const std::size_t next = at == std::string::npos ? at : page.find("\n## ", at + heading.size());
  const std::string before = at == std::string::npos ? page + "\n" : page.substr(0, at + 1);
  return before + heading + "\nMade by `drape reference --readmes`; do not edit.\n\n" +
         describe_markdown(entry.schema, shared) + (next == std::string::npos ? "" : page.substr(next));
}

}  // namespace drape
