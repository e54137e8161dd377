#include <algorithm>
#include <functional>

#include "core/report/html.h"
#include "core/report/tables.h"
#include "core/report/text_table.h"

namespace drape {

namespace {

using html::Cell;
using html::escape;
using html::figure;

using Row = std::vector<Cell>;

Cell words(const std::string& content) { return {content, false}; }

/// A column of a table of consistency measures: a method of this run or of the paper.
struct Source {
  std::string title;
  std::function<std::optional<ConsistencyRecord>(int coarse, int fine)> find;
};

std::vector<Source> sources_of(const RunData& run) {
  std::vector<Source> sources;
  for (const MethodRecord& method : run.methods) {
    if (method.consistency.empty()) continue;
    sources.push_back({method.name, [&method](int coarse, int fine) {
                         const ConsistencyRecord* pair = method.pair(coarse, fine);
                         return pair ? std::optional(*pair) : std::nullopt;
                       }});
  }
  return sources;
}

std::vector<Source> sources_of(const Table1Block& block) {
  std::vector<Source> sources;
  for (const Table1Row& row : block.rows) {
    const bool known =
        std::any_of(sources.begin(), sources.end(), [&](const Source& s) { return s.title == row.method; });
    if (known) continue;
    sources.push_back({row.method, [&block, method = row.method](int coarse, int fine) {
                         std::optional<ConsistencyRecord> found;
                         for (const Table1Row& r : block.rows) {
                           if (r.method != method || r.coarse != coarse || r.fine != fine) continue;
                           found.emplace();
                           found->d_H_fit = r.d_H_fit;
                           found->d_H_ddg = r.d_H_ddg;
                           found->d_K_fit = r.d_K_fit;
                           found->d_K_ddg = r.d_K_ddg;
                         }
                         return found;
                       }});
  }
  return sources;
}

struct Measure {
  const char* plain_name;
  const char* name;  ///< HTML
  const char* unit;
  Figure ConsistencyRecord::*value;
};

constexpr Measure curvature_measures[] = {
    {"d_H_fit", "d<sub>H</sub><sup>fit</sup>", "1", &ConsistencyRecord::d_H_fit},
    {"d_H_ddg", "d<sub>H</sub><sup>ddg</sup>", "1", &ConsistencyRecord::d_H_ddg},
    {"d_K_fit", "d<sub>K</sub><sup>fit</sup>", "1/m²", &ConsistencyRecord::d_K_fit},
    {"d_K_ddg", "d<sub>K</sub><sup>ddg</sup>", "1/m²", &ConsistencyRecord::d_K_ddg}};
constexpr Measure distance_measure = {"distance", "distance, RMS", "diagonal",
                                      &ConsistencyRecord::distance_rms};

/// The cells of one row, its lowest figures strong when there is something to compare.
void add_compared(Row& row, const std::vector<Source>& sources, const Measure& measure, int coarse,
                  int fine) {
  std::vector<Figure> values;
  Figure lowest;
  int known = 0;
  for (const Source& source : sources) {
    const auto record = source.find(coarse, fine);
    values.push_back(record ? (*record).*(measure.value) : Figure());
    if (!values.back()) continue;
    ++known;
    lowest = std::min(lowest.value_or(*values.back()), *values.back());
  }
  for (const Figure& value : values) {
    row.push_back({figure(value), true, known > 1 && value && *value == *lowest});
  }
}

std::string measures_table(const std::vector<std::pair<int, int>>& pairs, const std::vector<Source>& run,
                           const std::vector<Source>& paper) {
  Row titles = {words("levels"), words("measure"), words("unit")};
  for (const Source& source : run) titles.push_back({escape(source.title)});
  for (const Source& source : paper) titles.push_back({source.title});
  std::vector<Row> head = {titles};
  if (!run.empty() && !paper.empty()) {
    head.insert(head.begin(),
                Row{Cell{"", false, false, 1, 3}, Cell{"this run", true, false, 1, int(run.size())},
                    Cell{"paper, Table 1", true, false, 1, int(paper.size())}});
  }
  std::vector<Row> body;
  const int measures = run.empty() ? 4 : 5;
  for (const auto& [coarse, fine] : pairs) {
    for (int k = 0; k < measures; ++k) {
      const Measure& measure = k < 4 ? curvature_measures[k] : distance_measure;
      Row row;
      if (k == 0) {
        row.push_back(words(std::to_string(coarse) + " → " + std::to_string(fine)));
        row.back().rows = measures;
      }
      row.push_back(words(measure.name));
      row.push_back(words(measure.unit));
      add_compared(row, run, measure, coarse, fine);
      add_compared(row, paper, measure, coarse, fine);
      body.push_back(row);
    }
  }
  return html::table(head, body);
}

}  // namespace

std::string consistency_table(const RunData& run, const Table1Block* published) {
  const std::vector<Source> sources = sources_of(run);
  if (sources.empty()) return "<p class=\"absent\">No pair of levels has been compared in this run.</p>";
  return measures_table(run.pairs(), sources, published ? sources_of(*published) : std::vector<Source>());
}

std::string published_table(const Table1Block& block) {
  std::vector<std::pair<int, int>> pairs;
  for (const Table1Row& row : block.rows) {
    const std::pair<int, int> pair(row.coarse, row.fine);
    if (std::find(pairs.begin(), pairs.end(), pair) == pairs.end()) pairs.push_back(pair);
  }
  return measures_table(pairs, {}, sources_of(block));
}

std::string table1_text(const RunData& run) {
  const Table1Block* published = table1_block(run.table1_scene);
  std::vector<Source> sources = sources_of(run);
  if (sources.empty()) return run.experiment + ": no pair of levels has been compared\n";
  if (published) {
    for (Source& source : sources_of(*published)) {
      source.title = "paper: " + source.title;
      sources.push_back(std::move(source));
    }
  }
  std::vector<std::vector<std::string>> rows = {{"levels", "measure", "unit"}};
  for (const Source& source : sources) rows.front().push_back(source.title);
  for (const auto& [coarse, fine] : run.pairs()) {
    for (const Measure& measure : curvature_measures) {
      rows.push_back(
          {std::to_string(coarse) + " → " + std::to_string(fine), measure.plain_name, measure.unit});
      for (const Source& source : sources) {
        const auto record = source.find(coarse, fine);
        rows.back().push_back(figure(record ? (*record).*(measure.value) : Figure()));
      }
    }
  }
  std::string text = text_table(rows);
  if (published) text = "This run beside “" + published->scene + "” of the supplement's Table 1:\n" + text;
  const std::optional<Verdict> verdict = intersection_verdict(run);
  return verdict ? text + verdict->text + "\n" : text;
}

}  // namespace drape
