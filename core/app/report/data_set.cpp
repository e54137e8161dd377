#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "core/app/report/report.h"
#include "core/app/report/run_export.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/number_text.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/mesh_files/io_formats.h"

namespace drape {

namespace {

namespace fs = std::filesystem;

/// The name of a garment's files: after the variation, without the endings of files in it; then the seed and
/// the method where there are several.
std::string name_of(const RunRecord& run, const std::string& method, const RunCollection& collection,
                    std::set<std::string>& taken) {
  const std::string whole = run.folder.parent_path().filename().string();
  std::string more;
  const bool is_obstacles = whole.starts_with("obstacle_");  // whose names have no comma
  if (is_obstacles || std::ranges::count(collection.runs, run.name, &RunRecord::name) > 1)
    more += "," + run.folder.filename().string();
  if (run.data->methods.size() > 1) more += "," + method;
  const std::string name =
      std::regex_replace(whole, std::regex(R"(\.[A-Za-z]\w*(?=,|$))"), std::string()) + more;
  return taken.insert(name).second ? name : whole + more;
}

/// What belongs to the OBJ of a method's end.
Json description_of(const RunData& run, const LevelRecord& end, const TableRow& row) {
  Json all = row;
  all["pieces"] = member_of(end.values, "pieces");
  all["experiment"] = json_value(run.config);
  all["fields"] = Json::object();
  for (const VertexField& field : end.mesh.fields()) {
    Json& values = all["fields"][field.name] = Json::array();
    for (const double value : field.values)
      values.push_back(std::isfinite(value) ? Json(parse_number(general_text(value, 6)).value()) : Json());
  }
  return all;
}

}  // namespace

RunTable export_data_set(const fs::path& sweep, const fs::path& folder, const ExportOptions& options) {
  const fs::path inside = fs::weakly_canonical(folder).lexically_relative(fs::canonical(sweep));
  if (!inside.empty() && *inside.begin() != "..")
    refuse_path(folder, "is in the sweep's own folder, whose files it would replace; name another folder");
  if (!options.overwrite && fs::exists(folder) && !fs::is_empty(folder))
    refuse_path(folder, "exists already; name another folder, or write into it with --overwrite");
  refuse_other_file(folder / "index.html", "move it, or name another folder");
  make_folder(folder);
  const RunCollection collection = read_runs({sweep});
  RunTable table = table_of(collection);
  table.columns.insert(table.columns.begin() + 2, "mesh");
  std::set<std::string> taken;
  std::map<std::string, std::string> obstacles;  // names of their files, by what these hold
  std::size_t next = 0;
  for (const RunRecord& run : collection.runs) {
    if (!run.has_methods()) ++next;
    for (std::size_t m = 0; run.data && m < run.data->methods.size(); ++m) {
      const MethodRecord& method = run.data->methods[m];
      TableRow& row = table.rows[next++];
      const std::vector<const LevelRecord*> levels = method.recorded_levels();
      if (row["pass"] != true || levels.empty()) continue;
      const std::string name = name_of(run, method.name, collection, taken);
      ExportOptions own = options;
      own.method = method.name;
      export_run(run.folder, folder / (name + ".obj"), own);
      row["mesh"] = name + ".obj";
      Json description = description_of(*run.data, *levels.back(), row);
      description["obstacles"] = Json::array();
      for (const ObstacleRecord& obstacle : run.data->obstacles) {
        const std::string next = "obstacle_" + std::to_string(obstacles.size()) + ".obj";
        const auto [file, is_new] = obstacles.try_emplace(obj_text(obstacle.mesh.mesh()), next);
        if (is_new) write_file(folder / next, file->first, options.existing());
        description["obstacles"].push_back(file->second);
      }
      write_file(folder / (name + ".json"), json_text(description) + "\n", options.existing());
    }
  }
  write_file(folder / "index.csv", table_text(table, {}, TableFormat::csv), options.existing());
  write_runs_report({sweep}, folder / "index.html");
  return table;
}

}  // namespace drape
