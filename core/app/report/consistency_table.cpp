#include <algorithm>
#include <functional>

#include "core/app/report/pair_measures.h"
#include "core/app/report/tables.h"
#include "core/app/report/text_table.h"
#include "core/app/view/html.h"

namespace drape {

namespace {

using html::Cell;
using html::escape;
using html::number_text;

using Row = std::vector<Cell>;

constexpr const char* start_title = "flat start";

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

std::vector<std::optional<ConsistencyRecord>> records_of(const std::vector<Source>& sources, int coarse,
                                                         int fine) {
  std::vector<std::optional<ConsistencyRecord>> records;
  for (const Source& source : sources) records.push_back(source.find(coarse, fine));
  return records;
}

std::vector<const ConsistencyRecord*> pointers_to(
    const std::vector<std::optional<ConsistencyRecord>>& records) {
  std::vector<const ConsistencyRecord*> pointers;
  for (const auto& record : records)
    if (record) pointers.push_back(&*record);
  return pointers;
}

/// The cells of one row, the best one in bold.
void add_compared(Row& row, const std::vector<Source>& sources, const PairMeasure& measure, int coarse,
                  int fine) {
  const auto records = records_of(sources, coarse, fine);
  const OptionalNumber best = best_of(measure, pointers_to(records));
  for (const auto& record : records) {
    const OptionalNumber value = record ? (*record).*(measure.value) : OptionalNumber();
    row.push_back({number_text(value), true, best && value && *value == *best});
  }
}

/// The score of the scene's initial state in place of the coarse states: one number if it is equal for all
/// methods as displayed, else the range.
std::string start_cell(const std::vector<Source>& sources, const PairMeasure& measure, int coarse, int fine) {
  std::vector<double> values;
  for (const auto& record : records_of(sources, coarse, fine))
    if (record && record->of_start.*(measure.value)) values.push_back(*(record->of_start.*(measure.value)));
  if (values.empty()) return number_text({});
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const std::string from = number_text(*low), to = number_text(*high);
  return from == to ? from : from + " … " + to;
}

std::string measures_table(const std::vector<std::pair<int, int>>& pairs, const std::vector<Source>& run,
                           const std::vector<Source>& paper) {
  Row titles = {words("levels"), words("measure"), words("unit")};
  for (const Source& source : run) titles.push_back({escape(source.title)});
  if (!run.empty()) titles.push_back({start_title});
  for (const Source& source : paper) titles.push_back({source.title});
  std::vector<Row> head = {titles};
  if (!run.empty() && !paper.empty()) {
    head.insert(head.begin(),
                Row{Cell{"", false, false, 1, 3}, Cell{"this run", true, false, 1, int(run.size()) + 1},
                    Cell{"paper, Table 1", true, false, 1, int(paper.size())}});
  }
  std::vector<Row> body;
  const int measures = run.empty() ? published_measures : static_cast<int>(std::size(pair_measures));
  for (const auto& [coarse, fine] : pairs) {
    for (int k = 0; k < measures; ++k) {
      const PairMeasure& measure = pair_measures[k];
      Row row;
      if (k == 0) {
        row.push_back(words(std::to_string(coarse) + " → " + std::to_string(fine)));
        row.back().rows = measures;
      }
      row.push_back(words(measure.html));
      row.push_back(words(measure.unit));
      add_compared(row, run, measure, coarse, fine);
      if (!run.empty()) row.push_back({start_cell(run, measure, coarse, fine)});
      add_compared(row, paper, measure, coarse, fine);
      body.push_back(row);
    }
  }
  return html::table(head, body);
}

}  // namespace

OptionalNumber best_of(const PairMeasure& measure, const std::vector<const ConsistencyRecord*>& records) {
  const ConsistencyRecord* best = nullptr;
  int known = 0;
  for (const ConsistencyRecord* record : records) {
    const OptionalNumber& value = record->*measure.value;
    if (!value) continue;
    ++known;
    if (!best || measure.beats(*value, *(best->*measure.value))) best = record;
  }
  if (known < 2) return {};
  const OptionalNumber& start = best->of_start.*measure.value;  // unknown for runs of earlier versions
  if (start && !measure.beats(*(best->*measure.value), *start)) return {};
  return best->*measure.value;
}

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
  const std::vector<Source> own = sources_of(run);
  std::vector<Source> sources = own;
  if (sources.empty()) return run.experiment + ": no pair of levels has been compared\n";
  if (published) {
    for (Source& source : sources_of(*published)) {
      source.title = "paper: " + source.title;
      sources.push_back(std::move(source));
    }
  }
  std::vector<std::vector<std::string>> rows = {{"levels", "measure", "unit"}};
  for (std::size_t k = 0; k < sources.size(); ++k) {
    rows.front().push_back(sources[k].title);
    if (k + 1 == own.size()) rows.front().push_back(start_title);
  }
  for (const auto& [coarse, fine] : run.pairs()) {
    for (const PairMeasure& measure : pair_measures) {
      rows.push_back({std::to_string(coarse) + " → " + std::to_string(fine), measure.name, measure.unit});
      for (std::size_t k = 0; k < sources.size(); ++k) {
        const auto record = sources[k].find(coarse, fine);
        rows.back().push_back(number_text(record ? (*record).*(measure.value) : OptionalNumber()));
        if (k + 1 == own.size()) rows.back().push_back(start_cell(own, measure, coarse, fine));
      }
    }
  }
  std::string text = text_table(rows);
  if (published) text = "This run beside “" + published->scene + "” of the supplement's Table 1:\n" + text;
  const std::optional<Verdict> verdict = intersection_verdict(run);
  return verdict ? text + verdict->text + "\n" : text;
}

}  // namespace drape
