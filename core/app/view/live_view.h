#pragma once

#include <atomic>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>

#include "core/app/scene/scene.h"
#include "core/app/view/live_server.h"
#include "core/app/view/view_document.h"
#include "core/kernel/threads/stopwatch.h"

namespace drape {

/// Shows a run in a browser while it proceeds, and forwards the page's "stop" and "refine now". While a page
/// is open, up to 5 % of the run's time go to the states that it shows. Results do not depend on it.
class LiveView : public Observer {
 public:
  /// Starts to serve (see LiveServer) the chosen methods of the experiment, all if none is named. `scene`
  /// must outlive the view.
  LiveView(const Experiment& experiment, const Scene& scene, const std::vector<std::string>& methods,
           int port);

  const std::string& url() const { return server_->url(); }

  void method_started(const std::string& method);
  void level_started(int level) override;
  void iteration(const IterationRow& row, const Positions& x) override;
  void level_finished(const LevelResult& result) override;
  /// Shows the outcome on the page, and waits a moment for an open page to read it.
  void run_finished(const std::string& outcome);

  bool stop_requested() override { return stop_; }
  bool refine_requested() override { return refine_.exchange(false); }

 private:
  /// What the page has of a method and level.
  struct LevelView {
    std::string status = "running";
    int iteration = 0;
    double seconds = 0;
    Positions x;  // of the state that is shown, without rows at first
    SurfaceFields fields;
    std::shared_ptr<const std::vector<TriangleMesh>> obstacles;  // null for where they were first
    bool stale = false;                                          // not encoded, or in other colour ranges
    Json state;                                                  // as ViewDocument makes it; null at first
    std::string name;                                            // of its blocks
    std::string sent, sent_before;  // of those that pages know, and may still request
  };

  void show(LevelView& view, int level, const Positions& x, const Eigen::VectorXd& pressure = {});
  bool listened_to() const;
  void encode_stale();
  std::string news(long version, std::size_t rows);
  std::string refine();
  std::shared_ptr<const std::string> block(const std::string& name);
  void forget_blocks(const std::string& state);

  const Scene& scene_;
  const std::string title_;
  std::vector<std::string> methods_;
  int finest_ = 0;

  std::atomic<bool> stop_ = false, refine_ = false;

  std::mutex mutex_;  // of everything down to the server
  std::condition_variable heard_;
  long version_ = 1, heard_version_ = 0, encoded_ = 0;
  std::string outcome_;  // once the run is over
  int method_ = -1, level_ = 0;
  std::map<std::pair<int, int>, LevelView> levels_;  // by number of the method, and level
  Json rows_ = Json::array();                        // [method, level, seconds, residual]
  double last_heard_ = -1e9, last_shown_ = -1e9, seconds_to_show_ = 0;
  std::map<std::string, std::shared_ptr<const std::string>> blocks_;
  Stopwatch clock_;
  const std::vector<TriangleMesh> first_obstacles_;
  std::shared_ptr<const std::vector<TriangleMesh>> obstacles_;  // under the values of the schedule's keys
  std::vector<double> load_;                                    // these values
  ViewDocument document_;

  std::unique_ptr<LiveServer> server_;  // last: its threads use the rest
};

}  // namespace drape
