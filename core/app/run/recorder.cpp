#include "core/app/run/recorder.h"

#include <algorithm>
#include <utility>

#include "core/app/experiment/declared_metrics.h"
#include "core/app/experiment/garment_place.h"
#include "core/app/report/run_data.h"
#include "core/app/report/run_table.h"
#include "core/app/run/garment_pieces.h"
#include "core/app/run/recorder_files.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/threads/parallel.h"
#include "core/kernel/threads/stopwatch.h"
#include "core/kernel/version.h"

namespace drape {

namespace {

/// Null for a level that did not end at an equilibrium; the verdict alone for one that was not tested.
Json stability_entry(const LevelResult& r) {
  const std::string verdict = stability_word(r);
  if (!r.stability) return verdict.empty() ? Json() : Json{{"verdict", verdict}};
  return {{"verdict", verdict},
          {"lowest_eigenvalue", r.stability->lowest_eigenvalue},
          {"curvature_ratio", r.stability->curvature_ratio},
          {"extent", r.stability->extent},
          {"found_by", r.stability->by_factorisation ? "factorisation" : "iterations"},
          {"saddles_left", r.saddles_left}};
}

/// The cells of iterations.csv after `method`, each behind its column's name; `intersections` is the number
/// of pairs, where every iteration is checked.
std::vector<std::pair<const char*, std::string>> cells_of(const IterationRow& row,
                                                          std::optional<int> intersections) {
  return {{"level", std::to_string(row.level)},
          {"step", std::to_string(row.step)},
          {"iteration", std::to_string(row.iteration)},
          {"seconds", general_text(row.seconds, 9)},
          {"energy", general_text(row.energy, 17)},
          {"decrement", general_text(row.decrement, 9)},
          {"force_residual", general_text(row.force_residual, 9)},
          {"step_length", general_text(row.step_length, 9)},
          {"proxy_energy", number_cell(row.proxy_energy, 17)},
          {"step_size", general_text(row.step_size, 9)},
          {"contacts", number_cell(row.contacts, 10)},
          {"smallest_gap", number_cell(row.smallest_gap, 6)},
          {"intersections", number_cell(intersections, 10)},
          {"flops", general_text(row.flops, 9)},
          {"time", number_cell(row.time, 9)}};
}

/// The message of a level, and where a garment that is not at rest is farthest from it.
std::string message_of(const LevelResult& r, const LevelModel& model, double force_tolerance) {
  const std::vector<std::string>& pieces = model.level().rest.piece_names;
  if (pieces.empty() || has_converged(r.outcome) || r.force_residual <= force_tolerance || !r.x.allFinite())
    return r.message;
  Positions force;
  model.energy_gradient(r.x, force);
  Eigen::Index vertex = 0;
  for (Eigen::Index i = 0; i < force.rows(); ++i)
    if (model.fixed()[i]) force.row(i).setZero();
  force.rowwise().squaredNorm().maxCoeff(&vertex);
  return r.message + "; the largest force is at " + place_in_garment(model.level(), static_cast<int>(vertex));
}

/// The table of a garment's openings.
Json entries_of(const std::vector<GarmentOpening>& openings) {
  Json entries = Json::array();
  for (const GarmentOpening& opening : openings) {
    const Eigen::Vector3d& middle = opening.middle;
    entries.push_back({{"pieces", opening.pieces},
                       {"middle", {middle.x(), middle.y(), middle.z()}},
                       {"length", opening.length},
                       {"passes", opening.passed}});
  }
  return entries;
}

/// What runs, and where.
Json program_and_machine() {
  return {{"version", std::string("drape ") + version()},
          {"commit", commit()},
          {"machine",
           {{"cpu", cpu_name()},
            {"processors", processor_count()},
            {"cores", core_count()},
            {"threads", thread_count()}}}};
}

}  // namespace

Recorder::Recorder(const RunFolder& folder, const Experiment& experiment, const Scene& scene,
                   std::uint64_t iterations_bytes, std::uint64_t log_bytes)
    : folder_(folder),
      experiment_(experiment),
      scene_(scene),
      iterations_(own_file(folder.file("iterations.csv"), iterations_bytes), std::ios::app),
      log_(own_file(folder.file("log.jsonl"), log_bytes), std::ios::app) {}

Recorder::Recorder(const RunFolder& folder, const Experiment& experiment, const Scene& scene)
    : Recorder(folder, experiment, scene, 0, 0) {
  iterations_ << "method";
  for (const auto& [name, cell] : cells_of({}, {})) iterations_ << ',' << name;
  iterations_ << std::endl;
  require_written(iterations_, "iterations.csv");
  const ExperimentParameters& p = experiment.parameters;
  results_["experiment"] = p.name;
  results_["description"] = p.description;
  results_["complete"] = false;
  results_.update(program_and_machine());
  results_["tolerance"] = {{"force_residual", p.newton.force_tolerance}};
  const std::vector<std::string> remarks = remarks_of(experiment, scene);
  if (!remarks.empty()) results_["remarks"] = remarks;
  results_["metrics"] = json_of(declared_metrics(experiment.metrics));
  results_["methods"] = Json::object();
  if (scene.reference) results_["reference"] = {{"file", p.reference.file}, {"mesh", "reference.ply"}};
  save();
  write_scene();
  save();
  log("run_started", {{"experiment", p.name}});
  for (const std::string& line : remarks) log("remark", {{"message", line}});
}

Recorder::Recorder(const RunFolder& folder, const Experiment& experiment, const Scene& scene,
                   const Recorder::State& state)
    : Recorder(folder, experiment, scene, state.iterations_bytes,
               // That of a run that is only measured goes on at its end.
               complete_results(folder.path()).is_null() ? state.log_bytes
                                                         : size_of_file(folder.file("log.jsonl"))) {
  s_ = state;
  results_ = parse_json(std::exchange(s_.results, ""));
  const Json now = program_and_machine(),
             before = results_.contains("resumed") ? results_["resumed"].back() : results_;
  solved_ = !complete_results(folder.path()).is_null();
  for (const auto& [key, value] : now.items())
    if (!solved_ && member_of(before, key) != value) {
      results_["resumed"].push_back(now);
      break;
    }
  if (scene_.load_stepping && !s_.last_load.values.empty())
    scene_.load_stepping->restore(scene_.finest(), s_.last_load);
  reset_peak_memory();
  write_again();
  restored_ = std::exchange(written_, {});
  save();
  log("run_resumed", {{"method", s_.method}});
  for (const std::string& file : restored_) log("file_restored", {{"file", file}});
}

Recorder::State Recorder::state() const {
  State s = s_;
  s.cpu += clock_.cpu_seconds();
  s.results = json_text(results_);
  s.iterations_bytes = size_of_file(folder_.file("iterations.csv"));
  s.log_bytes = size_of_file(folder_.file("log.jsonl"));
  sync_to_disk(folder_.file("iterations.csv"));
  sync_to_disk(folder_.file("log.jsonl"));
  return s;
}

void Recorder::warm_started_from(const std::string& where) {
  results_["warm_started_from"] = where;
  save();
}

void Recorder::require_written(const std::ofstream& stream, const char* name) const {
  if (!stream) throw WriteError("cannot write " + folder_.file(name).string() + ": is the disk full?");
}

void Recorder::log(const char* event, const Json& more) {
  Json entry = {{"event", event}};
  entry.update(more);
  entry["time"] = wall_clock();
  log_ << json_text(entry) << std::endl;
  require_written(log_, "log.jsonl");
}

void Recorder::save() const {
  if (!solved_) write_file(folder_.file("results.json"), json_text(results_, 1) + "\n");
}

void Recorder::method_started(const std::string& method) {
  s_.method = method;
  s_.intersection_free = true;
  s_.spent = Cost();
  s_.overhead = 0;
  reset_peak_memory();
  method_entry() = {{"status", "running"},     {"solver", experiment_.solver_type(method)},
                    {"seconds", 0.0},          {"peak_memory_bytes", 0},
                    {"levels", Json::array()}, {"consistency", Json::array()}};
  save();
  log("method_started", {{"method", method}});
}

void Recorder::level_started(int level) {
  s_.snapshots = {};
  s_.last = Cost();
  s_.overhead_before = s_.overhead;
  s_.increments = s_.cpu = 0;
  s_.load = load_average();
  clock_ = WorkClock();
  log("level_started", {{"method", s_.method}, {"level", level}});
}

std::optional<int> Recorder::intersections(int level, const Positions& x) {
  const auto& contacts = scene_.model(level)->contacts();
  if (contacts.empty()) return std::nullopt;
  constexpr std::size_t max_logged = 10;  // of each contact model
  int count = 0;
  for (const auto& contact : contacts) {
    const std::vector<Intersection> found = contact->intersections(x);
    for (std::size_t k = 0; k < std::min(found.size(), max_logged); ++k)
      log("intersection", {{"method", s_.method}, {"level", level}, {"pair", to_string(found[k])}});
    count += static_cast<int>(found.size());
  }
  if (count > 0) s_.intersection_free = false;
  return count;
}

void Recorder::iteration(const IterationRow& r, const Positions& x) {
  const WorkClock watch;
  IterationRow row = r;
  row.seconds -= s_.overhead;
  s_.last = {std::max(row.seconds - s_.spent.seconds, 0.0), s_.last.iterations + 1, r.flops};
  row.flops += s_.spent.flops;
  s_.snapshots.iteration(s_.last, x, experiment_.parameters.snapshots);
  std::optional<int> crossing;
  if (experiment_.parameters.check_intersections == IntersectionCheck::every_step)
    crossing = intersections(r.level, x);
  iterations_ << s_.method;
  for (const auto& [name, cell] : cells_of(row, crossing)) iterations_ << ',' << cell;
  iterations_ << std::endl;
  require_written(iterations_, "iterations.csv");
  exclude(watch);
}

Json Recorder::state_entry(const LevelResult& r, const Cost& cost) {
  const Level& level = scene_.hierarchy.levels[r.level];
  const LevelModel model = scene_.model(r.level)->with_stiffness(r.contact_stiffness);
  Json parts = Json::object(), released_parts = parts;
  for (const auto& [name, joules] : model.energy_parts(r.x)) parts[name] = joules;
  for (const auto& [name, joules] : model.energy_parts(scene_.placed[r.level]))
    released_parts[name] = joules - parts[name].get<double>();
  const std::optional<int> crossing = intersections(r.level, r.x);
  const bool apart = crossing.value_or(0) == 0;
  const double on_finest = energy_on_finest(r.level, r.x);
  return {{"level", r.level},
          {"vertices", level.vertex_count()},
          {"triangles", level.triangle_count()},
          {"status", to_string(apart ? r.outcome : Outcome::infeasible)},
          {"message", apart ? message_of(r, model, experiment_.force_tolerance(s_.method))
                            : "the state has intersections; log.jsonl names them"},
          {"steps", r.steps},
          {"iterations", r.iterations},
          {"from_initial_state", r.from_initial_state},
          {"factorisations", r.factorisations},
          {"flops", r.flops},
          {"analyses", r.analyses},
          {"seconds", cost.seconds},
          {"seconds_by_phase", r.seconds_by_phase},
          {"energy", model.energy(r.x)},
          {"energy_parts", parts},
          {"energy_on_finest", on_finest},
          {"energy_released", json_of(energy_released(scene_, on_finest))},
          {"energy_parts_released", scene_.garment ? Json() : released_parts},
          {"decrement", r.decrement},
          {"force_residual", r.force_residual},
          {"stability", stability_entry(r)},
          {"intersections", crossing ? Json(*crossing) : Json()},
          {"smallest_gap", json_of(r.smallest_gap)},
          {"contact_stiffness", r.contact_stiffness},
          {"mesh", level_file(s_.method, r.level, ".ply")}};
}

void Recorder::increment_finished(const IncrementRow& r, const Positions& x) {
  const WorkClock watch;
  const LevelModel& model = *scene_.model(r.level);
  const double seconds = std::max(s_.last.seconds - s_.increments, 0.0);  // without what recording took
  s_.increments += seconds;
  Json& increments = method_entry()["increments"];
  increments.push_back(
      {{"level", r.level},
       {"increment", r.increment},
       {"time", r.time},
       {"steps", r.steps},
       {"iterations", r.iterations},
       {"seconds", seconds},
       {"energy", r.energy},
       {"energy_released",
        scene_.garment ? Json() : Json(model.value(scene_.placed[r.level]) - model.value(x))},
       {"force_residual", r.force_residual},
       {"max_constraint_violation", r.max_constraint_violation}});
  const std::string phase = scene_.load_stepping->phase();
  if (!phase.empty()) increments.back()["phase"] = phase;
  if (scene_.load_stepping->ends_phase() && experiment_.parameters.snapshots > 0)
    s_.snapshots.keep(s_.last, x);
  exclude(watch);
}

void Recorder::level_finished(const LevelResult& r) {
  const WorkClock watch;
  const double cpu = std::max(s_.cpu + clock_.cpu_seconds(), 0.0);
  const LevelModel model = scene_.model(r.level)->with_stiffness(r.contact_stiffness);
  RecordedState state{s_.method, r.level, r.x, model.contact_pressure(r.x)};
  const VertexFields garment = garment_fields_of(state);
  const std::uint32_t mesh_checksum = write_state(state, garment);
  Json& entry = method_entry();
  // By the clock of the rows, which includes the setup of the objective; a level's own seconds exclude it.
  const double own = r.seconds - (s_.overhead - s_.overhead_before);
  const Cost cost = {std::max(own, s_.last.seconds), r.iterations, r.flops};
  entry["levels"].push_back(state_entry(r, cost));
  entry["levels"].back().update({{"cpu_seconds", cpu},
                                 {"load_before", s_.load},
                                 {"load_after", load_average()},
                                 {"mesh_checksum", mesh_checksum}});
  if (scene_.garment) {
    const Level& level = scene_.hierarchy.levels[r.level];
    entry["levels"].back()["pieces"] =
        garment_pieces(level, r.x, garment.back().values, state.contact_pressure);
    entry["levels"].back()["openings"] = entries_of(scene_.garment->openings(model, r.x));
  }
  if (experiment_.parameters.snapshots > 0)
    entry["levels"].back()["snapshots"] = add_snapshots(r, cost, state);
  s_.states.push_back(std::move(state));
  s_.spent = s_.spent + cost;
  follow_schedule();
  entry["seconds"] = entry["seconds"].get<double>() + cost.seconds;
  entry["peak_memory_bytes"] = std::max(entry["peak_memory_bytes"].get<std::int64_t>(), peak_memory_bytes());
  save();
  log("level_finished", {{"method", s_.method},
                         {"level", r.level},
                         {"status", to_string(r.outcome)},
                         {"message", r.message},
                         {"seconds", cost.seconds}});
  exclude(watch);
}

void Recorder::run_finished(bool complete, bool measured) {
  results_["complete"] = complete;
  if (!measured) results_["measured"] = false;
  results_["ended"] = solved_ ? complete_results(folder_.path())["ended"] : Json(wall_clock());
  if (complete) solved_ = false;
  save();
  log("run_finished", {{"complete", complete}});
  // The checkpoint, from which they could be written again, is removed next.
  for (const char* name : {"results.json", "iterations.csv", "log.jsonl"}) sync_to_disk(folder_.file(name));
}

}  // namespace drape
