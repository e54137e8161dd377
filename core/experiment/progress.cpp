#include "core/experiment/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace drape {

Progress::Progress(double tolerance, int levels, bool quiet)
    : tolerance_(tolerance), levels_(levels), quiet_(quiet), terminal_(isatty(STDERR_FILENO)) {}

void Progress::method_started(const std::string& method) { method_ = method; }

void Progress::level_started(int) {
  level_clock_ = Stopwatch();
  last_draw_ = 0;
  first_residual_ = 0;
  track_.clear();
}

void Progress::iteration(const IterationRow& row, const Positions&) {
  if (first_residual_ == 0) first_residual_ = row.force_residual;
  const double now = level_clock_.seconds();
  track_.emplace_back(now, row.force_residual);
  if (quiet_ || now - last_draw_ < (terminal_ ? 0.1 : 10)) return;
  last_draw_ = now;
  draw(row);
}

/// Carries the residual's decay over the later half of the level so far on to the tolerance.
double Progress::seconds_to_go() const {
  if (track_.size() < 8) return -1;
  const auto& [t0, r0] = track_[track_.size() / 2];
  const auto& [t1, r1] = track_.back();
  const double rate = std::log(r0 / r1) / (t1 - t0);
  return rate > 0 ? std::log(r1 / tolerance_) / rate : -1;
}

void Progress::draw(const IterationRow& row) {
  const double part = std::clamp(
      std::log(first_residual_ / row.force_residual) / std::log(first_residual_ / tolerance_), 0.0, 1.0);
  constexpr int width = 16;
  std::string bar;
  for (int k = 0; k < width; ++k) bar += k < part * width ? "█" : "░";
  char to_go[32] = "";
  if (const double s = seconds_to_go(); s >= 0) std::snprintf(to_go, sizeof to_go, "  about %.0f s to go", s);
  clear_line();
  std::fprintf(stderr, "%-9s level %d/%d %s step %-4d residual %.2e  energy %.6g J%s%s", method_.c_str(),
               row.level, levels_ - 1, bar.c_str(), row.step, row.force_residual, row.energy, to_go,
               terminal_ ? "" : "\n");
  std::fflush(stderr);
  drawn_ = terminal_;
}

void Progress::clear_line() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

void Progress::level_finished(const LevelResult& r) {
  if (quiet_) return;
  clear_line();
  std::fprintf(stderr, "%-9s level %d/%d %-12s %5d steps %8.2f s  residual %.2e%s%s\n", method_.c_str(),
               r.level, levels_ - 1, to_string(r.outcome), r.steps, r.seconds, r.force_residual,
               r.message.empty() ? "" : "  ", r.message.c_str());
}

}  // namespace drape
