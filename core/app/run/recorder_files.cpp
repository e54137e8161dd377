#include "core/app/run/recorder_files.h"

#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "core/app/files/json_file.h"
#include "core/app/report/run_data.h"
#include "core/app/view/surface_fields.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/mesh_files/io.h"

namespace drape {

namespace {

/// As write_file, unless the file has these bytes already. Returns whether it wrote.
bool write_where_other(const std::filesystem::path& path, std::string_view bytes) {
  std::error_code none;
  if (std::filesystem::is_regular_file(path, none) &&
      std::filesystem::file_size(path, none) == bytes.size() && read_file(path) == bytes)
    return false;
  write_file(path, bytes);
  return true;
}

}  // namespace

std::string number_cell(const std::optional<double>& value, int digits) {
  return value && std::isfinite(*value) ? general_text(*value, digits) : "";
}

std::string level_file(const std::string& method, int level, const char* extension) {
  return "levels/" + method + "_l" + std::to_string(level) + extension;
}

double wall_clock() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::uint64_t size_of_file(const std::filesystem::path& file) {
  std::error_code error;
  const std::uint64_t bytes = std::filesystem::file_size(file, error);
  if (error) throw WriteError(file, error.value());
  return bytes;
}

std::filesystem::path own_file(const std::filesystem::path& file, std::uint64_t bytes) {
  std::error_code error;
  if (bytes == 0)
    write_file(file, "");
  else if (std::filesystem::is_symlink(file) || std::filesystem::hard_link_count(file) > 1)
    write_file(file, read_file(file, std::numeric_limits<std::uintmax_t>::max()));
  std::filesystem::resize_file(file, bytes, error);
  if (error) throw WriteError(file, error.value());
  return file;
}

std::vector<std::string> write_rest(const std::filesystem::path& folder, const Scene& scene) {
  std::vector<std::string> written;
  make_folder(folder / "rest");
  for (const Level& level : scene.hierarchy.levels) {
    const std::string name = rest_file(level.index);
    if (write_where_other(folder / name, ply_bytes(level.rest))) written.push_back(name);
  }
  return written;
}

std::string written_again_text(const std::vector<std::string>& files) {
  return "damaged or missing files were written again: " + joined(files);
}

void refuse_short_files(const RunFolder& folder, const Recorder::State& state) {
  for (const auto& [name, bytes] :
       {std::pair("iterations.csv", state.iterations_bytes), {"log.jsonl", state.log_bytes}}) {
    const std::filesystem::path file = folder.file(name);
    if (!std::filesystem::is_regular_file(file))  // a pipe would block the resumed run
      refuse_path(
          file,
          "is missing, and the run cannot be resumed without: put it back, or run the experiment again");
    if (size_of_file(file) < bytes)
      refuse_path(file,
                  "is shorter than when the checkpoint was made; it was changed since, and the run cannot be "
                  "resumed: run the experiment again");
  }
}

void record_abort(const RunFolder& folder, const std::string& cause) {
  try {
    Json results = parse_json(read_file(folder.file("results.json")));
    results["aborted"] = cause;
    for (auto& [name, method] : results.at("methods").items())
      if (method.at("status").get<std::string>() == "running") method["status"] = "aborted";
    write_file(folder.file("results.json"), json_text(results, 1) + "\n");
    const std::filesystem::path log = folder.file("log.jsonl");
    std::ofstream(own_file(log, size_of_file(log)), std::ios::app)
        << json_text({{"event", "run_aborted"}, {"message", cause}, {"time", wall_clock()}}) << std::endl;
  } catch (const std::exception&) {
    // The cause of the abort may prevent this write too; message and exit code remain.
  }
}

void Recorder::write(const std::string& name, const std::string& bytes) {
  if (write_where_other(folder_.file(name), bytes)) written_.push_back(name);
}

void Recorder::write_scene() {
  written_ = write_rest(folder_.path(), scene_);
  if (scene_.reference)
    write("reference.ply", ply_bytes({*scene_.reference, scene_.hierarchy.levels.back().rest.triangles}));
  write_obstacles();
}

void Recorder::write_obstacles() {
  Json& entries = results_["obstacles"] = Json::array();
  std::vector<std::string> names = experiment_.obstacle_names();
  const std::vector<TriangleMesh> obstacles = scene_.finest_model().obstacles();
  names.resize(obstacles.size());
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    const std::string file = "obstacles/" + std::to_string(k) + ".ply";
    entries.push_back({{"mesh", file}, {"name", names[k]}});
    // A run that was killed after its last checkpoint may have moved them since: that is no damage.
    const bool may_differ = scene_.load_stepping && std::filesystem::exists(folder_.file(file));
    write(file, ply_bytes(obstacles[k]));
    if (may_differ) std::erase(written_, file);
  }
}

void Recorder::follow_schedule() {
  // A method that is stopped on the way leaves them where another's final states have them.
  const LoadStepping* schedule = scene_.load_stepping.get();
  if (!schedule || (!schedule->finished() && schedule->increment() <= s_.last_load.increment)) return;
  s_.last_load = schedule->state();
  write_obstacles();
}

VertexFields Recorder::garment_fields_of(const RecordedState& state) const {
  if (!scene_.garment) return {};
  return garment_fields_at(scene_.hierarchy.levels[state.level], state.x, scene_.finest_model().obstacles());
}

std::uint32_t Recorder::write_state(const RecordedState& state, const VertexFields& garment) {
  const TriangleMesh mesh{state.x, scene_.hierarchy.levels[state.level].rest.triangles};
  VertexFields fields;
  if (state.contact_pressure.size() > 0) fields.push_back({"contact_pressure", state.contact_pressure});
  fields.insert(fields.end(), garment.begin(), garment.end());
  const std::string ply = ply_bytes(mesh, fields);
  const auto write_level = [&](const char* extension, const std::string& bytes) {
    const std::string name = level_file(state.method, state.level, extension);
    write(name, bytes);
    sync_to_disk(folder_.file(name));  // later checkpoints rely on it
  };
  write_level(".ply", ply);
  write_level(".vtp", vtp_text(mesh, fields));
  return checksum_of(ply);
}

void Recorder::write_collection(const std::string& method) {
  std::vector<std::pair<double, std::string>> meshes;
  for (const RecordedState& state : s_.states)
    if (state.method == method)
      meshes.emplace_back(state.level,  // the collection is in levels/ too
                          level_file(method, state.level, ".vtp").substr(std::strlen("levels/")));
  write("levels/" + method + ".pvd", pvd_text(meshes));
}

void Recorder::write_again() {
  for (const char* part : {"levels", "fields", "obstacles"}) make_folder(folder_.file(part));
  write_scene();
  for (const RecordedState& state : s_.states) write_state(state, garment_fields_of(state));
  for (const auto& [name, method] : results_["methods"].items())
    if (method["status"].get<std::string>() != "running") write_collection(name);
  restore_fields();
}

}  // namespace drape
