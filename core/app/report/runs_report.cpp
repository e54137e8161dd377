#include "core/app/report/runs_report.h"

#include <algorithm>
#include <stdexcept>

#include "core/app/report/run_rows.h"
#include "core/app/report/tables.h"
#include "core/app/view/embedded.h"
#include "core/app/view/html.h"
#include "core/kernel/files/file.h"

namespace drape {

namespace {

using html::escape;

std::string consistency(const RunCollection& collection) {
  std::string text;
  const std::vector<std::string> variations = collection.variations();
  for (const std::string& variation : variations) {
    const RunData medians = median_consistency(collection, variation);
    const std::string table = consistency_table(medians);
    text += variations.size() == 1 ? table
                                   : "<details" + std::string(text.empty() ? " open" : "") + "><summary>" +
                                         escape(variation) + "</summary>\n" + table + "</details>\n";
  }
  return text;
}

std::string run_list(const RunCollection& collection, const std::filesystem::path& page) {
  using html::Cell;
  std::vector<std::vector<Cell>> body;
  const auto from = std::filesystem::absolute(page).parent_path();
  for (const RunRecord& run : collection.runs) {
    OptionalNumber seconds;
    if (run.data)
      for (const MethodRecord& m : run.data->methods)
        if (m.seconds) seconds = seconds.value_or(0) + *m.seconds;
    const auto report = std::filesystem::absolute(run.folder / "report.html");
    const std::string name = escape(run.folder.generic_string());
    body.push_back(
        {{escape(run.variation), false},
         {html::count(run.seed)},
         {escape(run.status), false},
         {html::number_text(seconds)},
         {std::filesystem::is_regular_file(report)
              ? "<a href=\"" + html::url_path(report.lexically_relative(from)) + "\">" + name + "</a>"
              : name,
          false}});
  }
  return html::table({{{"variation", false}, {"seed"}, {"status", false}, {"time [s]"}, {"report", false}}},
                     body);
}

std::string machines(const RunCollection& collection) {
  std::vector<std::string> lines;
  for (const RunRecord& run : collection.runs) {
    if (!run.data) continue;
    std::string line = escape(run.data->version) + " · " + escape(run.data->cpu);
    if (run.data->threads) line += " · threads a run: " + html::count(run.data->threads);
    if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
  }
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "<br>") + line;
  if (lines.size() > 1) text += "<br>More than one machine or setting: their times do not compare.";
  return text;
}

/// Only a page of drape's may be replaced: its title says so.
void refuse_other_file(const std::filesystem::path& page) {
  if (std::filesystem::exists(page) && read_file(page).find(" – drape</title>") == std::string::npos)
    throw std::runtime_error(page.string() +
                             ": is there already, and no report of drape; name another page with --out");
}

}  // namespace

void write_runs_report(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& page) {
  refuse_other_file(page);
  const RunCollection collection = read_runs(folders);
  const std::string failures = failures_table(collection);
  write_file(page,
             html::fill(Embedded::runs_html(),
                        {{"style", std::string(Embedded::page_css())},
                         {"title", escape(collection.name.empty() ? "Several runs" : collection.name)},
                         {"summary", collection_summary(collection)},
                         {"machine", machines(collection)},
                         {"rows", rows_table(collection)},
                         {"failures", failures.empty() ? "" : "<h3>What did not finish</h3>\n" + failures},
                         {"consistency", consistency(collection)},
                         {"runs", run_list(collection, page)},
                         {"data", rows_chart_data(collection)},
                         {"chart_library", std::string(Embedded::chart_js())},
                         {"charts", std::string(Embedded::charts_js())},
                         {"script", std::string(Embedded::runs_js())}}));
}

}  // namespace drape
