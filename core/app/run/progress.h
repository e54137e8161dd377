#pragma once

#include <string>
#include <vector>

#include "core/kernel/interfaces/solver.h"
#include "core/kernel/threads/stopwatch.h"

namespace drape {

/// How much a run writes to standard error: nothing, its progress, or a line for every iteration.
enum class Verbosity { quiet, progress, iterations };

/// Shows a run on the terminal: one line that is rewritten while a level is solved (a new line now and then
/// if standard error is not a terminal, one for every iteration if the user asks for them), and a permanent
/// one for every finished level.
class Progress : public Observer {
 public:
  /// The bar is full at `tolerance` of the force residual; `levels` is their number. Under load stepping
  /// (`load_stepping`, which changes the parameters `changing`) it is full after the last increment.
  Progress(double tolerance, int levels, Verbosity verbosity, const LoadStepping* load_stepping = nullptr,
           const std::vector<std::string>& changing = {});

  void method_started(const std::string& method);
  void level_started(int level) override;
  void iteration(const IterationRow& row, const Positions& x) override;
  void level_finished(const LevelResult& result) override;
  void method_failed(int level, const std::string& cause);
  void not_measured(const std::string& metric, const std::string& cause);

  /// The line with the bar after an iteration.
  std::string line(const IterationRow& row) const;
  /// The line of an iteration under Verbosity::iterations.
  std::string details(const IterationRow& row) const;

 private:
  void take_note(const IterationRow& row);
  void begin_phase(const IterationRow& row, std::string phase);
  void draw(const IterationRow& row);
  void clear_line();

  double tolerance_;
  int levels_;
  Verbosity verbosity_;
  bool terminal_, drawn_ = false;
  const LoadStepping* load_stepping_;
  std::string changing_, method_;
  std::string phase_;  // of the schedule, which began with this iteration:
  IterationRow phase_begin_;
  Stopwatch level_clock_;
  double last_draw_ = 0;
  int increment_ = 0;                              // of the residuals
  double first_residual_ = 0, best_residual_ = 0;  // of the current increment; 0 before the first
  double done_ = 0;                                // fraction of the level, in [0, 1]
  double to_go_ = 0;                               // by the rate so far, smoothed [s]; 0 if not known
};

}  // namespace drape
