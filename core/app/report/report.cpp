#include "core/app/report/report.h"

#include <unistd.h>

#include <cerrno>
#include <map>
#include <system_error>

#include "core/app/experiment/experiment.h"
#include "core/app/report/compare.h"
#include "core/app/report/pictures.h"
#include "core/app/report/run_table.h"
#include "core/app/view/page.h"
#include "core/kernel/files/file.h"
#include "core/numerics/mesh_files/base64.h"

namespace drape {

namespace {

namespace fs = std::filesystem;

constexpr int thumbnail_width = 300;    // [pixels]
constexpr std::size_t most_rows = 500;  // of one level of one method; more points are not visible

/// A CSV file of a run, with the number of each row in its series; of a long series evenly chosen rows.
Json csv_json(const Csv& csv) {
  const auto series = [&](std::size_t k) { return csv.text(k, "method") + "/" + csv.text(k, "level"); };
  std::map<std::string, std::size_t> counts, seen;
  for (std::size_t k = 0; k < csv.size(); ++k) ++counts[series(k)];
  Json rows = Json::array(), names = csv.names();
  for (std::size_t k = 0; k < csv.size(); ++k) {
    const std::size_t count = counts[series(k)], number = ++seen[series(k)];
    const std::size_t stride = (count + most_rows - 1) / most_rows;
    if ((number - 1) % stride != 0 && number != count) continue;
    Json& row = rows.emplace_back(Json::array());
    for (const std::string& name : csv.names())
      row.push_back(name == "method" ? Json(csv.text(k, name)) : json_of(csv.number(k, name)));
    row.push_back(number);
  }
  names.push_back("row");
  return {{"names", names}, {"rows", rows}};
}

Json measures_json(const std::vector<ErrorMeasure>& measures) {
  Json all = Json::array();
  for (const ErrorMeasure& m : measures)
    all.push_back(
        {{"name", m.name}, {"label", m.label}, {"use", m.use == ErrorUse::ranking ? "ranking" : "other"}});
  return all;
}

/// What a page draws of each method: its look, and where the experiment has them the settings beside its
/// lines.
Json methods_json(const RunCollection& collection) {
  Json methods = Json::object();
  for (const RunRecord& run : collection.runs) {
    if (!run.data) continue;
    const auto number = [&](const MethodRecord& method, const char* key) {
      return json_of(newton_number(run.data->config, method.name, key));
    };
    for (const MethodRecord& method : run.data->methods)
      methods.emplace(method.name, Json{{"style", solver_style(method.solver)},
                                        {"step_size", number(method, "step_size")},
                                        {"tolerance", number(method, "force_tolerance")}});
  }
  return methods;
}

/// Small pictures of the ends of a run's methods.
Json thumbnails(const RunData& run) {
  std::vector<std::string> notes;
  const PictureScene scene(run, notes, {.width = thumbnail_width, .edges = false});
  Json all = Json::array();
  for (const MethodRecord& method : run.methods)
    if (const TriangleMesh* end = method.levels.empty() ? nullptr : scene.state(method.levels.back()))
      all.push_back({{"method", method.name}, {"png", base64(encode_png(scene.draw(*end)))}});
  return all;
}

fs::path own_report(const RunRecord& run) {
  return fs::absolute(run.folder / "report.html").lexically_normal();
}

/// Describes a run for the page. First writes the run's own report, without pictures, if it is missing or
/// older than its results.
Json run_json(const RunRecord& run, const fs::path& from) {
  const fs::path report = own_report(run), results = run.folder / "results.json";
  if (run.data && access(run.folder.c_str(), W_OK) == 0 && !is_current(report, results)) try {
      write_report(run.folder, [] { return true; });  // without pictures, which take longest
    } catch (const std::exception&) {
      // There is no link to it then.
    }
  Json entry = {
      {"variation", run.variation},
      {"seed", json_of(run.seed)},
      {"status", run.status},
      {"error", run.error},
      {"count", run.has_methods() ? run.data->methods.size() : 1},
      {"report", fs::is_regular_file(report) ? Json(url_path(report.lexically_relative(from))) : Json()},
      {"pictures", run.data ? thumbnails(*run.data) : Json::array()},
      {"errors", csv_json(run.data ? run.data->errors : Csv())},
      {"first_levels", Json::object()}};
  if (!run.data) return entry;
  for (const MethodRecord& method : run.data->methods)
    entry["first_levels"][method.name] = method.first_level();
  for (const char* about : {"version", "commit", "machine", "ended", "reference"})
    entry[about] = member_of(run.data->results, about);
  return entry;
}

/// Before anything is drawn or written.
void refuse_unwritable(const fs::path& folder, const std::string& remedy) {
  if (access(folder.c_str(), W_OK) != 0)
    refuse_path(folder, "cannot be written to (" + std::generic_category().message(errno) + "); " + remedy);
}

}  // namespace

void refuse_other_file(const fs::path& page, const std::string& remedy) {
  if (fs::exists(page) && read_file(page).find(" – drape</title>") == std::string::npos)
    refuse_path(page, "is there already, and no report of drape; " + remedy);
}

bool is_current(const fs::path& page, const fs::path& results) {
  std::error_code error;
  return fs::exists(page, error) && fs::exists(results, error) &&
         fs::last_write_time(page, error) >= fs::last_write_time(results, error);
}

std::vector<std::string> write_report(const fs::path& folder, const std::function<bool()>& cancelled,
                                      std::optional<int> picture_width) {
  if (!fs::is_symlink(folder / "report.html"))  // a link is replaced, and not followed
    refuse_other_file(folder / "report.html", "move it");
  const RunCollection collection = read_runs({folder});
  refuse_unwritable(folder, "copy the folder to where it can, and name the copy");
  const RunData& run = *collection.runs.front().data;
  PictureSet set;
  if (cancelled && member_of(run.results, "measured") == false)
    set.notes.push_back("The preview was not measured and no picture was drawn: drape report " +
                        folder.string() + " does both.");
  else
    set = draw_pictures(run, cancelled, picture_width);
  const ReportView view = report_view(run, set.notes);
  const Json data = {{"kind", "run"},
                     {"results", run.results},
                     {"table", table_json(collection)},
                     {"measures", measures_json(error_measures(run.metrics))},
                     {"methods", methods_json(collection)},
                     {"errors", csv_json(run.errors)},
                     {"iterations", csv_json(run.iterations)},
                     {"config", run.configuration},
                     {"pictures", set.ends},
                     {"notes", set.notes},
                     {"view", view.document}};
  write_file(folder / "report.html",
             page(run.experiment.empty() ? "Unnamed experiment" : run.experiment, data, view.blocks));
  return set.notes;
}

void write_runs_report(const std::vector<fs::path>& folders, const fs::path& file) {
  refuse_other_file(file, "name another page with --out");
  const RunCollection collection = read_runs(folders);
  const fs::path place = fs::absolute(file).lexically_normal();
  const fs::path parent = file.parent_path();
  refuse_unwritable(parent.empty() ? "." : parent, "name a page elsewhere with drape report --out");
  for (const RunRecord& run : collection.runs)
    if (std::error_code error; own_report(run) == place || fs::equivalent(own_report(run), place, error))
      refuse_path(file, "is the place of a run's own report; name another page with --out");
  Json runs = Json::array();
  for (const RunRecord& run : collection.runs) runs.push_back(run_json(run, place.parent_path()));
  write_file(file, page(collection.name.empty() ? "Several runs" : collection.name,
                        {{"kind", "runs"},
                         {"name", collection.name},
                         {"description", collection.description},
                         {"complete", collection.complete},
                         {"table", table_json(collection)},
                         {"measures", measures_json(collection.error_measures())},
                         {"metrics", json_of(collection.metrics())},
                         {"model_keys", model_keys()},
                         {"methods", methods_json(collection)},
                         {"runs", runs}}));
}

}  // namespace drape
