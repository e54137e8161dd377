#pragma once

#include <string>
#include <vector>

#include "core/model/solver.h"
#include "core/numerics/stopwatch.h"

namespace drape {

/// Shows a run on the terminal: one line that is rewritten while a level is solved (a plain line now and
/// then where standard error is no terminal), and one that stays for every level done.
class Progress : public Observer {
 public:
  /// `tolerance` of the force residual is where the bar is full; `levels` how many there are.
  Progress(double tolerance, int levels, bool quiet);

  void method_started(const std::string& method);
  void level_started(int level) override;
  void iteration(const IterationRow& row, const Positions& x) override;
  void level_finished(const LevelResult& result) override;

 private:
  double seconds_to_go() const;
  void draw(const IterationRow& row);
  void clear_line();

  double tolerance_;
  int levels_;
  bool quiet_, terminal_, drawn_ = false;
  std::string method_;
  double first_residual_ = 0;
  Stopwatch level_clock_;
  double last_draw_ = 0;
  std::vector<std::pair<double, double>> track_;  // seconds, force residual of the level
};

}  // namespace drape
