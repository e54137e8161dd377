#include "core/app/view/live_view.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/app/files/json_file.h"
#include "core/app/view/colours.h"
#include "core/app/view/page.h"

namespace drape {

namespace {

constexpr double shortest_pause = 0.25;  // between two copies of the running state [s]
constexpr double share_of_time = 0.05;   // largest share of time for encoding
constexpr double looked_lately = 5;      // since a page last asked [s]

}  // namespace

LiveView::LiveView(const Experiment& experiment, const Scene& scene, const std::vector<std::string>& methods,
                   int port)
    : scene_(scene),
      title_(experiment.parameters.name),
      tolerance_(experiment.parameters.newton.force_tolerance),
      finest_(static_cast<int>(scene.models.size()) - 1),
      first_obstacles_(std::make_shared<const Obstacles>(obstacles_of(scene.finest_model().contacts()))),
      document_(scene.hierarchy.levels, *first_obstacles_, !scene.finest_model().contacts().empty(),
                [this](const std::string& name, std::string bytes) { keep(name, std::move(bytes)); }) {
  for (const auto& [name, solver] : experiment.methods)
    if (methods.empty() || std::find(methods.begin(), methods.end(), name) != methods.end())
      methods_.push_back(name), styles_.push_back(solver_style(experiment.solver_type(name)));
  server_ = std::make_unique<LiveServer>(
      port, LiveAnswers{[this] { return page(); },
                        [this](long version, std::size_t rows) { return news(version, rows); },
                        [this](const std::string& name) { return block(name); }, [this] { stop_ = true; },
                        [this] { return refine(); }});
}

void LiveView::method_started(const std::string& method) {
  const std::lock_guard lock(mutex_);
  method_ = static_cast<int>(std::find(methods_.begin(), methods_.end(), method) - methods_.begin());
  ++version_;
}

void LiveView::level_started(int level) {
  const std::lock_guard lock(mutex_);
  refine_ = false;  // the request was for the last level
  level_ = level;
  last_copy_ = -1e9;
  ++version_;
}

void LiveView::iteration(const IterationRow& row, const Positions& x) {
  const std::lock_guard lock(mutex_);
  if (std::isfinite(row.force_residual))
    rows_.push_back({method_, row.level, row.seconds, row.force_residual});
  ++version_;
  const double now = clock_.seconds();
  const double pause = std::max(shortest_pause, (seconds_to_encode_ + seconds_to_copy_) / share_of_time);
  Shown& shown = states_[{method_, row.level}];
  ++shown.iteration;
  shown.seconds = row.seconds;
  if (now - last_heard_ > looked_lately) return;
  if (now - last_copy_ < pause) return;
  last_copy_ = now;
  copy_state(shown, x);
}

/// The schedule makes the finest level's model of a new load only now, if it is not the level that is being
/// solved.
void LiveView::copy_state(Shown& shown, const Positions& x) {
  const Stopwatch watch;
  if (scene_.load_stepping && scene_.load_stepping->state().values != load_) {
    load_ = scene_.load_stepping->state().values;
    obstacles_ = std::make_shared<const Obstacles>(obstacles_of(scene_.finest_model().contacts()));
  }
  shown.x = x;
  shown.obstacles = obstacles_;
  shown.fresh = true;
  seconds_to_copy_ = watch.seconds();
}

void LiveView::level_finished(const LevelResult& result) {
  const std::lock_guard lock(mutex_);
  Shown& shown = states_[{method_, result.level}];
  copy_state(shown, result.x);
  shown.status = to_string(result.outcome);
  shown.iteration = result.iterations;
  ++version_;
}

void LiveView::run_finished(const std::string& outcome) {
  std::unique_lock lock(mutex_);
  outcome_ = outcome;
  const long last = ++version_;
  if (clock_.seconds() - last_heard_ > looked_lately) return;
  heard_.wait_for(lock, std::chrono::seconds(5), [&] { return heard_version_ >= last; });
}

std::string LiveView::refine() {
  const std::lock_guard lock(mutex_);
  if (!outcome_.empty() || method_ < 0) return "No level is being solved.";
  if (level_ == finest_) return "This is the finest level: there is none to refine to.";
  refine_ = true;
  return "";
}

void LiveView::keep(const std::string& name, std::string bytes) {
  const std::lock_guard lock(mutex_);
  blocks_[name] = std::make_shared<const std::string>(std::move(bytes));
}

std::shared_ptr<const std::string> LiveView::block(const std::string& name) {
  const std::lock_guard lock(mutex_);
  const auto found = blocks_.find(name);
  return found == blocks_.end() ? nullptr : found->second;
}

/// A state's blocks have names that begin with its own and a dash.
void LiveView::forget_blocks(const std::string& state) {
  if (state.empty()) return;
  blocks_.erase(state);
  for (auto at = blocks_.lower_bound(state + "-"); at != blocks_.end() && at->first.starts_with(state + "-");)
    at = blocks_.erase(at);
}

/// Encodes the states that are new since the last call, without holding the lock.
void LiveView::encode_fresh() {
  while (true) {
    std::unique_lock lock(mutex_);
    const auto found =
        std::find_if(states_.begin(), states_.end(), [](const auto& state) { return state.second.fresh; });
    if (found == states_.end()) return;
    Shown& shown = found->second;  // states are never removed
    const int level = found->first.second;
    const std::string name = "m" + std::to_string(found->first.first) + "l" + std::to_string(level) + "v" +
                             std::to_string(++encoded_);
    const Positions x = shown.x;
    const std::shared_ptr<const Obstacles> obstacles = shown.obstacles;
    const int iteration = shown.iteration;
    const double seconds = shown.seconds;
    shown.fresh = false;
    lock.unlock();

    const Stopwatch watch;
    const SurfaceFields fields = document_.fields(level, x, obstacles.get());
    document_.set_ranges({&fields});
    Json entry = document_.state(name, x, fields, obstacles.get());
    entry["iteration"] = iteration;
    entry["seconds"] = seconds;

    lock.lock();
    seconds_to_encode_ = watch.seconds();
    forget_blocks(shown.before);
    shown.before = shown.name;
    shown.name = name;
    shown.entry = std::move(entry);
    ++version_;
  }
}

std::string LiveView::news(long version, std::size_t rows) {
  const std::lock_guard encoding(encoding_);
  {
    const std::lock_guard lock(mutex_);
    last_heard_ = clock_.seconds();
  }
  encode_fresh();
  const std::lock_guard lock(mutex_);
  if (version == version_) {
    heard_version_ = version;  // a further request: the page shows that version
    heard_.notify_all();
    return "";
  }
  Json methods = Json::array();
  for (std::size_t m = 0; m < methods_.size(); ++m) {
    Json levels = Json::array();
    for (const auto& [key, shown] : states_)
      if (key.first == static_cast<int>(m) && !shown.entry.is_null())
        levels.push_back(
            {{"level", key.second}, {"status", shown.status}, {"states", Json::array({shown.entry})}});
    methods.push_back({{"name", methods_[m]}, {"style", styles_[m]}, {"levels", levels}});
  }
  Json news = document_.document(title_, methods);
  news["version"] = version_;
  news["tolerance"] = tolerance_;
  news["outcome"] = outcome_;
  news["method"] = method_ < 0 ? "" : methods_[method_];
  news["level"] = level_;
  news["finest"] = finest_;
  news["first_row"] = std::min(rows, rows_.size());
  news["rows"] = Json::array();
  for (std::size_t k = rows; k < rows_.size(); ++k) news["rows"].push_back(rows_[k]);
  return ascii_json_text(news);
}

std::string LiveView::page() const {
  return drape::page(title_ + ", live", {{"kind", "live"}, {"title", title_}});
}

}  // namespace drape
