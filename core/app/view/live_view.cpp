#include "core/app/view/live_view.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/app/files/json_file.h"
#include "core/app/view/page.h"
#include "core/kernel/files/string_utils.h"

namespace drape {

namespace {

constexpr double shortest_pause = 0.25;  // between two states of a level [s]
constexpr double share_of_time = 0.05;   // largest share of time for showing them
constexpr double looked_lately = 5;      // since a page last asked [s]

}  // namespace

LiveView::LiveView(const Experiment& experiment, const Scene& scene, const std::vector<std::string>& methods,
                   int port)
    : scene_(scene),
      title_(experiment.parameters.name),
      finest_(static_cast<int>(scene.models.size()) - 1),
      first_obstacles_(scene.finest_model().obstacles()),
      document_(scene.hierarchy.levels, first_obstacles_, !scene.finest_model().contacts().empty(),
                [this](const std::string& name, std::string bytes) {
                  blocks_[name] = std::make_shared<const std::string>(std::move(bytes));
                }) {
  Json looks = Json::object();
  for (const auto& [name, solver] : experiment.methods) {
    if (!methods.empty() && !is_one_of(name, methods)) continue;
    methods_.push_back(name);
    looks[name] = {{"style", solver_style(experiment.solver_type(name))},
                   {"tolerance", experiment.force_tolerance(name)}};
  }
  server_ = std::make_unique<LiveServer>(
      port, LiveAnswers{page(title_ + ", live", {{"kind", "live"}, {"title", title_}, {"methods", looks}}),
                        [this](long version, std::size_t rows) { return news(version, rows); },
                        [this](const std::string& name) { return block(name); }, [this] { stop_ = true; },
                        [this] { return refine(); }});
}

void LiveView::method_started(const std::string& method) {
  const std::lock_guard lock(mutex_);
  method_ = static_cast<int>(std::ranges::find(methods_, method) - methods_.begin());
  ++version_;
}

void LiveView::level_started(int level) {
  const std::lock_guard lock(mutex_);
  refine_ = false;  // the request was for the last level
  level_ = level;
  last_shown_ = -1e9;
  ++version_;
}

void LiveView::iteration(const IterationRow& row, const Positions& x) {
  const std::lock_guard lock(mutex_);
  if (std::isfinite(row.force_residual))
    rows_.push_back({method_, row.level, row.seconds, row.force_residual});
  ++version_;
  LevelView& view = levels_[{method_, row.level}];
  ++view.iteration;
  view.seconds = row.seconds;
  const double now = clock_.seconds(), pause = std::max(shortest_pause, seconds_to_show_ / share_of_time);
  if (listened_to() && now - last_shown_ > pause) show(view, row.level, x);
}

/// The schedule makes the finest level's model of a new load only now, if it is not the level that is being
/// solved.
void LiveView::show(LevelView& view, int level, const Positions& x, const Eigen::VectorXd& pressure) {
  const Stopwatch watch;
  if (scene_.load_stepping && scene_.load_stepping->state().values != load_) {
    load_ = scene_.load_stepping->state().values;
    obstacles_ = std::make_shared<const std::vector<TriangleMesh>>(scene_.finest_model().obstacles());
  }
  view.x = x;
  view.obstacles = obstacles_;
  view.fields = document_.fields(level, x, pressure, obstacles_.get());
  std::vector<const SurfaceFields*> shown;
  for (const auto& [key, other] : levels_) shown.push_back(&other.fields);
  // Others are encoded again where the ranges grow, since their colours are cut off, and at the end of a
  // level, since their steps are coarse where the ranges have shrunk.
  const bool all = document_.set_ranges(shown) || view.status != "running";
  for (auto& [key, other] : levels_)
    if (&other == &view || (all && other.x.rows() > 0)) other.stale = true;
  if (listened_to()) encode_stale();
  ++version_;
  last_shown_ = clock_.seconds();
  seconds_to_show_ = watch.seconds();
}

bool LiveView::listened_to() const { return clock_.seconds() - last_heard_ < looked_lately; }

void LiveView::encode_stale() {
  for (auto& [key, view] : levels_) {
    if (!std::exchange(view.stale, false)) continue;
    if (view.name != view.sent) forget_blocks(view.name);
    view.name = "m" + std::to_string(++encoded_);
    view.state = document_.state(view.name, view.x, view.fields, view.obstacles.get());
    view.state["iteration"] = view.iteration;
    view.state["seconds"] = view.seconds;
  }
}

void LiveView::level_finished(const LevelResult& result) {
  const std::lock_guard lock(mutex_);
  LevelView& view = levels_[{method_, result.level}];
  view.status = to_string(result.outcome);
  view.iteration = result.iterations;
  const LevelModel model = scene_.model(result.level)->with_stiffness(result.contact_stiffness);
  show(view, result.level, result.x, model.contact_pressure(result.x));
}

void LiveView::run_finished(const std::string& outcome) {
  std::unique_lock lock(mutex_);
  outcome_ = outcome;
  const long last = ++version_;
  if (!listened_to()) return;
  heard_.wait_for(lock, std::chrono::seconds(5), [&] { return heard_version_ >= last; });
}

std::string LiveView::refine() {
  const std::lock_guard lock(mutex_);
  if (!outcome_.empty() || method_ < 0) return "No level is being solved.";
  if (level_ == finest_) return "This is the finest level: there is none to refine to.";
  refine_ = true;
  return "";
}

std::shared_ptr<const std::string> LiveView::block(const std::string& name) {
  const std::lock_guard lock(mutex_);
  const auto found = blocks_.find(name);
  return found == blocks_.end() ? nullptr : found->second;
}

/// A state's blocks have names that begin with its own and a dash.
void LiveView::forget_blocks(const std::string& state) {
  std::erase_if(blocks_, [&](const auto& block) { return (block.first + "-").starts_with(state + "-"); });
}

std::string LiveView::news(long version, std::size_t rows) {
  const std::lock_guard lock(mutex_);
  last_heard_ = clock_.seconds();
  if (version == version_) {
    heard_version_ = version;  // a further request: the page shows that version
    heard_.notify_all();
    return "";
  }
  encode_stale();  // what ended while nobody listened
  Json methods = Json::array();
  for (std::size_t m = 0; m < methods_.size(); ++m) {
    Json levels = Json::array();
    for (auto& [key, view] : levels_) {
      if (key.first != static_cast<int>(m) || view.state.is_null()) continue;
      const bool ended = !outcome_.empty() || key != std::pair(method_, level_);
      levels.push_back({{"level", key.second},
                        {"status", ended && view.status == "running" ? "failed" : view.status},
                        {"states", Json::array({view.state})}});
      if (view.sent == view.name) continue;
      forget_blocks(std::exchange(view.sent_before, std::exchange(view.sent, view.name)));
    }
    methods.push_back({{"name", methods_[m]}, {"levels", levels}});
  }
  Json news = document_.document(title_, methods);
  news["version"] = version_;
  news["outcome"] = outcome_;
  news["method"] = method_ < 0 ? "" : methods_[method_];
  news["level"] = level_;
  news["finest"] = finest_;
  news["rows"] = Json::array();
  for (std::size_t k = rows; k < rows_.size(); ++k) news["rows"].push_back(rows_[k]);
  return ascii_json_text(news);
}

}  // namespace drape
