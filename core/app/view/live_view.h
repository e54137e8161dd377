#pragma once

#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>

#include "core/app/experiment/experiment.h"
#include "core/app/view/live_server.h"
#include "core/app/view/view_document.h"
#include "core/kernel/threads/stopwatch.h"

namespace drape {

/// Shows a run in a browser while it proceeds, and forwards the page's "stop" and "refine now". The run only
/// copies a state now and then while a page is open; the server's threads do the rest. Results do not depend
/// on it.
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
  using Json = ViewDocument::Json;
  using Obstacles = std::vector<TriangleMesh>;
  struct Shown {
    Positions x;
    std::shared_ptr<const Obstacles> obstacles;  // under the load of x
    std::string status = "running";
    int iteration = 0;
    double seconds = 0;
    bool fresh = false;        // not encoded yet
    Json entry;                // of the state, once encoded
    std::string name, before;  // of its blocks and the replaced ones, which a page may still request
  };

  void copy_state(Shown& shown, const Positions& x);
  std::string page() const;
  std::string news(long version, std::size_t rows);
  std::string refine();
  void encode_fresh();
  void keep(const std::string& name, std::string bytes);
  std::shared_ptr<const std::string> block(const std::string& name);
  void forget_blocks(const std::string& state);

  const Scene& scene_;
  const std::string title_;
  const double tolerance_;
  std::vector<std::string> methods_;
  std::vector<int> styles_;  // of the methods
  int finest_ = 0;

  std::atomic<bool> stop_ = false, refine_ = false;

  std::mutex mutex_;  // of everything down to here; held for moments only
  std::condition_variable heard_;
  long version_ = 1, heard_version_ = 0;
  std::string outcome_;  // once the run is over
  int method_ = -1, level_ = 0;
  std::map<std::pair<int, int>, Shown> states_;  // by number of the method, and level
  Json rows_ = Json::array();                    // [method, level, seconds, residual]
  double last_heard_ = -1e9, last_copy_ = -1e9, seconds_to_encode_ = 0;
  std::map<std::string, std::shared_ptr<const std::string>> blocks_;
  Stopwatch clock_;

  const std::shared_ptr<const Obstacles> first_obstacles_;
  // Of the solver's thread alone: where the obstacles are, and the values of the schedule's keys there.
  std::shared_ptr<const Obstacles> obstacles_ = first_obstacles_;
  std::vector<double> load_;
  double seconds_to_copy_ = 0;

  std::mutex encoding_;  // of what only the server's threads use; taken before mutex_
  long encoded_ = 0;
  ViewDocument document_;
  std::unique_ptr<LiveServer> server_;  // last: its threads use the rest
};

}  // namespace drape
