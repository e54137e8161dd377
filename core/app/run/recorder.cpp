#include "core/app/run/recorder.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

#include "core/app/files/machine.h"
#include "core/app/run/recorder_files.h"
#include "core/app/run/reference.h"
#include "core/kernel/linear_algebra/parallel.h"
#include "core/kernel/linear_algebra/stopwatch.h"
#include "core/kernel/mesh/file.h"
#include "core/kernel/mesh/io.h"
#include "core/kernel/mesh/io_formats.h"
#include "core/kernel/version.h"

namespace drape {

namespace {

/// Status of a method that threw, and of its current level; no solver returns it.
constexpr const char* failed = "failed";

nlohmann::ordered_json finite_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

/// The member of an object with a dotted name: "a.b" is member b of member a.
nlohmann::ordered_json& at_dotted(nlohmann::ordered_json& object, const std::string& name) {
  const std::size_t dot = name.find('.');
  return dot == std::string::npos ? object[name]
                                  : at_dotted(object[name.substr(0, dot)], name.substr(dot + 1));
}

}  // namespace

Recorder::Recorder(const RunFolder& folder, const Experiment& experiment, const Scene& scene,
                   std::ios::openmode mode)
    : folder_(folder),
      experiment_(experiment),
      scene_(scene),
      steps_(folder.file("steps.csv"), mode),
      log_(folder.file("log.jsonl"), mode),
      snapshots_(experiment.parameters.snapshots),
      errors_(folder, experiment, scene) {}

Recorder::Recorder(const RunFolder& folder, const Experiment& experiment, const Scene& scene)
    : Recorder(folder, experiment, scene, std::ios::out) {
  steps_ << "method,level,step,iteration,seconds,energy,decrement,force_residual,step_length,proxy_energy,"
            "step_size,contacts,smallest_gap,intersections,flops"
         << std::endl;
  require_written(steps_, "steps.csv");
  const ExperimentParameters& p = experiment.parameters;
  results_["experiment"] = p.name;
  results_["description"] = p.description;
  results_["complete"] = false;
  results_["version"] = std::string("drape ") + version();
  results_["commit"] = commit();
  results_["machine"] = {{"cpu", cpu_name()}, {"cores", core_count()}, {"threads", thread_count()}};
  results_["tolerance"] = {{"force_residual", p.newton.force_tolerance}};
  results_["table1_scene"] = p.table1_scene;
  results_["methods"] = Json::object();
  save();
  write_scene();
  save();
  log({{"event", "run_started"}, {"experiment", p.name}});
}

Recorder::Recorder(const RunFolder& folder, const Experiment& experiment, const Scene& scene,
                   const RecorderState& state)
    : Recorder(folder, experiment, scene, std::ios::app) {
  cut_files(folder, state);
  results_ = Json::parse(state.results);
  method_ = state.method;
  intersection_free_ = state.intersection_free;
  method_intersection_free_ = state.method_intersection_free;
  states_ = state.states;
  snapshots_.restore(state.snapshots);
  errors_.restore(state.measured);
  spent_ = state.spent;
  last_ = state.last;
  overhead_ = state.overhead;
  reset_peak_memory();
  restored_ = write_again();
  save();
  log({{"event", "run_resumed"}, {"method", method_}});
  for (const std::string& file : restored_) log({{"event", "file_restored"}, {"file", file}});
}

RecorderState Recorder::state() const {
  const auto [steps_bytes, log_bytes] = file_sizes(folder_);
  RecorderState s{json_text(results_),
                  method_,
                  intersection_free_,
                  method_intersection_free_,
                  states_,
                  snapshots_.state(),
                  errors_.levels(),
                  spent_,
                  last_,
                  overhead_,
                  steps_bytes,
                  log_bytes};
  sync_to_disk(folder_.file("steps.csv"));
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

void Recorder::log(Json entry) {
  entry["time"] = wall_clock();
  log_ << json_text(entry) << std::endl;
  require_written(log_, "log.jsonl");
}

void Recorder::save() const { folder_.write_text("results.json", json_text(results_, 1) + "\n"); }

std::vector<const RecordedState*> Recorder::finest_states() const {
  std::vector<const RecordedState*> finest;
  for (const RecordedState& state : states_)
    if (state.level == static_cast<int>(scene_.models.size()) - 1) finest.push_back(&state);
  return finest;
}

std::string Recorder::file_of(const std::string& method, int level, const char* extension) const {
  return "levels/" + method + "_l" + std::to_string(level) + extension;
}

void Recorder::method_started(const std::string& method) {
  method_ = method;
  method_intersection_free_ = true;
  spent_ = Cost();
  overhead_ = 0;
  reset_peak_memory();
  method_entry() = {{"status", "running"},
                    {"seconds", 0.0},
                    {"peak_memory_bytes", 0},
                    {"levels", Json::array()},
                    {"consistency", Json::array()}};
  save();
  log({{"event", "method_started"}, {"method", method}});
}

void Recorder::level_started(int level) {
  snapshots_.begin_level();
  last_ = Cost();
  log({{"event", "level_started"}, {"method", method_}, {"level", level}});
}

Recorder::Json Recorder::intersections(int level, const Positions& x) {
  const auto& contacts = scene_.model(level).contacts();
  if (contacts.empty()) return nullptr;
  std::size_t count = 0;
  for (const auto& contact : contacts) {
    const std::vector<Intersection> touches = contact->intersections(x);
    for (std::size_t k = 0; k < std::min<std::size_t>(touches.size(), 10); ++k)
      log({{"event", "intersection"},
           {"method", method_},
           {"level", level},
           {"pair", to_string(touches[k])}});
    count += touches.size();
  }
  if (count > 0) intersection_free_ = method_intersection_free_ = false;
  return count;
}

void Recorder::iteration(const IterationRow& r, const Positions& x) {
  const double seconds = r.seconds - overhead_;
  last_ = {std::max(seconds - spent_.seconds, 0.0), last_.iterations + 1, r.flops};
  if (snapshots_.any()) snapshots_.iteration(last_, x);
  char line[400];
  std::snprintf(line, sizeof line, "%s,%d,%d,%d,%.6f,%.17g,%.9g,%.9g,%.9g,", method_.c_str(), r.level, r.step,
                r.iteration, seconds, r.energy, r.decrement, r.force_residual, r.step_length);
  steps_ << line;
  if (r.proxy_energy) std::snprintf(line, sizeof line, "%.17g", *r.proxy_energy), steps_ << line;
  std::snprintf(line, sizeof line, ",%.9g,", r.step_size);
  steps_ << line;
  if (r.contacts) steps_ << *r.contacts;
  steps_ << ',';
  if (r.smallest_gap && std::isfinite(*r.smallest_gap))
    std::snprintf(line, sizeof line, "%.6g", *r.smallest_gap), steps_ << line;
  steps_ << ',';
  if (experiment_.parameters.check_intersections == IntersectionCheck::every_step)
    if (const Json count = intersections(r.level, x); !count.is_null()) steps_ << count.dump();
  std::snprintf(line, sizeof line, ",%.9g", spent_.flops + r.flops), steps_ << line;
  steps_ << std::endl;
  require_written(steps_, "steps.csv");
}

Recorder::Json Recorder::state_entry(const LevelResult& r) {
  const Level& level = scene_.hierarchy.levels[r.level];
  const double energy = scene_.model(r.level).energy(r.x);
  const Json crossing = intersections(r.level, r.x);
  const bool apart = crossing.is_null() || crossing == 0;
  const auto weights = experiment_.solver_of(method_).interpolation(scene_.hierarchy);
  const double on_finest = energy_on_finest(scene_, weights, r.level, r.x);
  Json entry = {{"level", r.level},
                {"vertices", level.vertex_count()},
                {"triangles", level.triangle_count()},
                {"status", to_string(apart ? r.outcome : Outcome::infeasible)},
                {"message", apart ? r.message : "the state has intersections; log.jsonl names them"},
                {"steps", r.steps},
                {"newton_iterations", r.iterations},
                {"from_initial_state", r.from_initial_state},
                {"factorisations", r.factorisations},
                {"flops", r.flops},
                {"analyses", r.analyses},
                {"seconds", r.seconds},
                {"seconds_by_phase", r.seconds_by_phase},
                {"energy", finite_or_null(energy)},
                {"energy_on_finest", finite_or_null(on_finest)},
                {"decrement", finite_or_null(r.decrement)},
                {"force_residual", finite_or_null(r.force_residual)},
                {"intersections", crossing},
                {"smallest_gap", r.smallest_gap ? finite_or_null(*r.smallest_gap) : Json()},
                {"mesh", file_of(method_, r.level, ".ply")}};
  return entry;
}

void Recorder::increment_finished(const IncrementRow& r, const Positions&) {
  method_entry()["increments"].push_back({{"level", r.level},
                                          {"increment", r.increment},
                                          {"time", r.time},
                                          {"steps", r.steps},
                                          {"newton_iterations", r.iterations},
                                          {"seconds", r.seconds},
                                          {"energy", finite_or_null(r.energy)},
                                          {"force_residual", finite_or_null(r.force_residual)},
                                          {"max_constraint_violation", r.max_constraint_violation}});
}

void Recorder::level_finished(const LevelResult& r) {
  const Stopwatch watch;
  const RecordedState state{method_, r.level, r.x};
  write_state(state);
  Json& entry = method_entry();
  entry["levels"].push_back(state_entry(r));
  entry["levels"].back()["mesh_checksum"] =
      checksum_of(ply_bytes({r.x, scene_.hierarchy.levels[r.level].rest.triangles}));
  // By the clock of the rows, which includes the setup of the objective; a level's own seconds exclude it.
  const Cost cost = {std::max(r.seconds, last_.seconds), r.iterations, r.flops};
  if (snapshots_.any())
    entry["levels"].back()["snapshots"] = errors_.add(method_, r, snapshots_.end_level(cost, r.x),
                                                      r.from_initial_state ? Cost() : spent_, spent_);
  states_.push_back(state);
  spent_ = spent_ + cost;
  entry["seconds"] = entry["seconds"].get<double>() + r.seconds;
  entry["peak_memory_bytes"] = std::max(entry["peak_memory_bytes"].get<std::int64_t>(), peak_memory_bytes());
  save();
  log({{"event", "level_finished"},
       {"method", method_},
       {"level", r.level},
       {"status", to_string(r.outcome)},
       {"message", r.message},
       {"seconds", r.seconds}});
  overhead_ += watch.seconds();
}

MetricResult Recorder::measure(const std::string& name, const Metric& metric, const MetricInput& input,
                               Json& entry) {
  try {
    return metric.evaluate(input);
  } catch (const std::exception& error) {
    entry["not_measured"][name] = error.what();
    log({{"event", "not_measured"}, {"method", method_}, {"metric", name}, {"message", error.what()}});
    return {};
  }
}

Recorder::Json Recorder::compare(int level, const Positions& x, const Positions& other,
                                 const std::string& fields_file) {
  Json row = Json::object();  // not null, even without a metric of pairs
  VertexFields fields;
  for (const auto& [name, metric] : experiment_.metrics) {
    if (metric->scope() != MetricScope::pair) continue;
    const MetricResult result =
        measure(name, *metric, {scene_.hierarchy.levels[level], scene_.model(level), x, &other}, row);
    for (const MetricValue& v : result.values) row[v.name] = finite_or_null(v.value);
    for (const MetricField& f : result.fields) fields.push_back({f.name, f.values});
  }
  if (!fields_file.empty() && !fields.empty()) {
    write_ply(folder_.file(fields_file), {x, scene_.hierarchy.levels[level].rest.triangles}, fields);
    row["fields"] = fields_file;
  }
  return row;
}

void Recorder::method_finished(const std::vector<LevelResult>& results,
                               const std::optional<MethodFailure>& failure) {
  Json& entry = method_entry();
  // A level that failed during recording may have left an entry.
  while (entry["levels"].size() > results.size()) entry["levels"].erase(entry["levels"].size() - 1);
  Outcome worst = Outcome::converged;
  const int finest = static_cast<int>(scene_.models.size()) - 1;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const LevelResult& r = results[i];
    worst = worse_of(worst, r.outcome);
    Json& state = entry["levels"][i];
    for (const auto& [name, metric] : experiment_.metrics)
      if (metric->scope() == MetricScope::state)
        for (const MetricValue& v :
             measure(name, *metric, {scene_.hierarchy.levels[r.level], scene_.model(r.level), r.x}, state)
                 .values)
          at_dotted(state, v.name) = finite_or_null(v.value);
  }
  write_collection(method_);
  const auto weights = experiment_.solver_of(method_).interpolation(scene_.hierarchy);
  std::vector<Json> of_start;  // the initial state compared with each level's state
  for (const LevelResult& r : results)
    of_start.push_back(&r == &results.front() ? Json() : compare(r.level, r.x, scene_.starts[r.level], ""));
  for (std::size_t c = 0; c < results.size(); ++c)
    for (std::size_t f = c + 1; f < results.size(); ++f) {
      const int coarse = results[c].level, fine = results[f].level;  // a method may skip levels
      const Positions prolonged = scene_.hierarchy.prolong(results[c].x, coarse, fine, weights);
      const std::string tag = method_ + "_l" + std::to_string(coarse) + "_l" + std::to_string(fine);
      Json row = {{"coarse", coarse}, {"fine", fine}};
      row.update(compare(fine, results[f].x, prolonged, fine == finest ? "fields/" + tag + ".ply" : ""));
      row["of_start"] = of_start[f];
      entry["consistency"].push_back(row);
    }
  if (!method_intersection_free_) worst = Outcome::infeasible;
  entry["status"] = failure ? failed : to_string(worst);
  if (failure) {
    const Level& level = scene_.hierarchy.levels[failure->level];
    entry["levels"].push_back({{"level", failure->level},
                               {"vertices", level.vertex_count()},
                               {"triangles", level.triangle_count()},
                               {"status", failed},
                               {"message", failure->cause}});
    log({{"event", "method_failed"},
         {"method", method_},
         {"level", failure->level},
         {"message", failure->cause}});
  }
  save();
  log({{"event", "method_finished"}, {"method", method_}, {"status", entry["status"]}});
}

const RecordedState* Recorder::reference_state() const {
  const std::string& named = experiment_.parameters.reference.method;
  const RecordedState* lowest = nullptr;
  double lowest_energy = std::numeric_limits<double>::infinity();
  for (const RecordedState* state : finest_states()) {
    if (state->method == named) return state;
    for (const Json& entry : results_.at("methods").at(state->method).at("levels")) {
      if (entry.at("level") != state->level || !has_converged(entry.at("status").get<std::string>()))
        continue;
      const Json& energy = entry.at("energy");  // with limits and contact
      if (energy.is_number() && energy < lowest_energy) lowest = state, lowest_energy = energy;
    }
  }
  return named == ReferenceParameters::lowest ? lowest : nullptr;
}

const Positions* Recorder::find_reference(Observer& observer, bool cancelled) {
  const ReferenceParameters& p = experiment_.parameters.reference;
  if (scene_.reference) {
    results_["reference"] = {{"file", p.file}, {"mesh", "reference.ply"}};
    return &*scene_.reference;
  }
  const RecordedState* state = reference_state();
  if (!state) return nullptr;
  Json& entry = results_["reference"];
  entry = {{"method", state->method}, {"mesh", "reference.ply"}};
  if (p.method != state->method) entry["chosen"] = p.method;
  if (p.force_tolerance == 0 || cancelled) return &state->x;
  entry["force_tolerance"] = p.force_tolerance;
  try {
    solved_reference_ = solve_to_tolerance(experiment_, scene_, state->x, observer);
  } catch (const std::exception& error) {
    entry.update({{"status", failed}, {"message", error.what()}});
    log({{"event", "reference_solved"}, {"status", failed}, {"message", error.what()}});
    return &state->x;
  }
  entry.update({{"status", to_string(solved_reference_->outcome)},
                {"message", solved_reference_->message},
                {"force_residual", finite_or_null(solved_reference_->force_residual)},
                {"newton_iterations", solved_reference_->iterations},
                {"seconds", solved_reference_->seconds}});
  log({{"event", "reference_solved"}, {"status", to_string(solved_reference_->outcome)}});
  return &solved_reference_->x;
}

bool Recorder::measure_errors(Observer& observer, bool cancelled) {
  const ReferenceParameters& p = experiment_.parameters.reference;
  const int finest = static_cast<int>(scene_.models.size()) - 1;
  const Positions* reference = find_reference(observer, cancelled);
  if (reference) {
    write_ply(folder_.file("reference.ply"), {*reference, scene_.hierarchy.levels[finest].rest.triangles});
    for (const RecordedState* state : finest_states())
      if (&state->x != reference) {
        method_ = state->method;
        Json row = compare(finest, *reference, state->x, "");
        row["against"] = results_["reference"].value("method", p.file);
        method_entry()["reference"] = row;
      }
  }
  save();
  if (errors_.empty()) return !observer.stop_requested() || cancelled;
  const auto stop = [&] { return !cancelled && observer.stop_requested(); };
  const auto fault = [&](const std::string& message) {
    log({{"event", "not_measured"}, {"message", message}});
  };
  try {
    errors_.write(reference, stop, fault);
  } catch (const WriteError&) {
    throw;
  } catch (const std::exception& error) {
    fault(std::string("errors.csv: ") + error.what());
  }
  return !stop();
}

void Recorder::run_finished(bool complete) {
  results_["complete"] = complete;
  save();
  log({{"event", "run_finished"}, {"complete", complete}});
}

}  // namespace drape
