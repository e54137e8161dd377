#include <algorithm>
#include <chrono>
#include <cstdio>
#include <deque>
#include <list>
#include <stdexcept>
#include <thread>

#include "core/app/files/machine.h"
#include "core/app/sweep/process.h"
#include "core/app/sweep/sweep_folder.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/threads/stopwatch.h"

namespace drape {

namespace {

class LocalEngine {
 public:
  LocalEngine(const Sweep& sweep, const SweepFolder& folder, const SweepOptions& options)
      : sweep_(sweep), folder_(folder), options_(options), memory_(sweep, folder) {
    for (const SweepRun& run : sweep.runs) had_ += read_status(folder.files(run.folder)).has_results();
  }

  void run(const std::vector<std::size_t>& missing) {
    waiting_.assign(missing.begin(), missing.end());
    while (!waiting_.empty() || !running_.empty()) {
      if (options_.stop()) stop();
      start_what_fits();
      collect();
      refresh();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    folder_.refresh();
    if (replaced_)
      throw std::runtime_error(own_program().string() +
                               " or a library of it was replaced or removed while the sweep ran, so the "
                               "other runs were not started");
  }

 private:
  struct Running {
    const SweepRun& run;
    double memory;
    RunProcess process;
  };

  void stop() {
    if (stopping_) return;
    stopping_ = true;
    waiting_.clear();
    for (Running& r : running_) r.process.stop();
    if (!running_.empty())
      std::fprintf(stderr,
                   running_.size() == 1 ? "stopping: %zu run is saving its state\n"
                                        : "stopping: %zu runs are saving their states\n",
                   running_.size());
  }

  /// Memory for a new run [bytes]: the available memory less what the running ones may still allocate.
  double left() const {
    double promised = 0, growth = 0;
    for (const Running& r : running_) {
      promised += r.memory;
      growth += std::max(0.0, r.memory - double(r.process.resident_bytes()));
    }
    const double left = available_memory() - growth;
    return options_.memory > 0 ? std::min(left, options_.memory - promised) : left;
  }

  /// Writes sweep.json, which takes time by the number of all runs: in at most a tenth of the sweep's.
  void refresh() {
    if (!changed_ || since_refresh_.seconds() < pause_) return;
    const Stopwatch watch;
    folder_.refresh();
    changed_ = false;
    pause_ = 9 * watch.seconds();
    since_refresh_ = Stopwatch();
  }

  void start_what_fits() {
    while (!waiting_.empty() && running_.size() < std::size_t(options_.workers)) {
      const SweepRun& run = sweep_.runs[waiting_.front()];
      const double needed = memory_.bytes(run), left = this->left();
      if (needed > left) {
        if (!running_.empty()) return;
        std::fprintf(stderr,
                     "warning: %s, seed %d may need %.1f GB where %.1f GB are to be had; it runs alone\n",
                     printable(run.name).c_str(), run.seed, needed / 1e9, std::max(0.0, left) / 1e9);
      }
      // Another program would give the sweep's later runs other results than the earlier ones.
      replaced_ = own_program_replaced();
      if (replaced_) return waiting_.clear();
      running_.push_back(
          {run, needed,
           RunProcess(folder_.files(run.folder), options_, sweep_.parameters.time_limit.value_or(0))});
      waiting_.pop_front();
      changed_ = true;
      if (needed > left) return;
    }
  }

  void collect() {
    for (auto r = running_.begin(); r != running_.end();) {
      if (!r->process.ended()) {
        ++r;
        continue;
      }
      const SweepRun& run = r->run;
      const RunStatus status = r->process.status();
      running_.erase(r++);
      if (status.has_results()) memory_.learn(run, folder_.files(run.folder));
      changed_ = true;
      tell(run, status);
    }
  }

  void tell(const SweepRun& run, const RunStatus& status) {
    const bool expected = refused_as_expected(run.expect, status),
               failed = status.state == RunState::failed && !expected;
    ++ended_;
    failed_ += failed;
    if (options_.quiet && !failed) return;
    std::string line = "[" + std::to_string(had_ + ended_) + "/" + std::to_string(sweep_.runs.size()) + "] " +
                       run.name + ", seed " + std::to_string(run.seed) + ": " +
                       (expected ? "refused, as expected," : to_string(status.state)) + " after " +
                       duration_text(status.seconds);
    if (failed_) line += "; " + std::to_string(failed_) + " failed";
    const std::size_t rest = waiting_.size() + running_.size();
    if (rest > 0 && !stopping_)
      line += "; " + std::to_string(rest) + " to go, about " +
              duration_text(clock_.seconds() / double(ended_) * double(rest));
    std::fprintf(stderr, "%s\n", printable(line).c_str());
    if (failed) std::fprintf(stderr, "%s\n", printable_lines(status.error).c_str());
  }

  const Sweep& sweep_;
  const SweepFolder& folder_;
  const SweepOptions& options_;
  MemoryEstimate memory_;
  Stopwatch clock_, since_refresh_;
  double pause_ = 0;  // until sweep.json may be written again [s]
  std::deque<std::size_t> waiting_;
  std::list<Running> running_;
  std::size_t had_ = 0, ended_ = 0, failed_ = 0;
  bool stopping_ = false, replaced_ = false, changed_ = false;
};

}  // namespace

void run_locally(const Sweep& sweep, const SweepFolder& folder, const std::vector<std::size_t>& missing,
                 const SweepOptions& options) {
  LocalEngine(sweep, folder, options).run(missing);
}

}  // namespace drape
