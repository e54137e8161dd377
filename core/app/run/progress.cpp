#include "core/app/run/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"

namespace drape {

namespace {

/// Intervals between updates of the line: a terminal follows the run, a log stays short [s].
constexpr double terminal_interval = 0.1, log_interval = 10;
/// No estimate of the time to go before this fraction of the increments; share of an iteration in the
/// estimate. A residual falls too unevenly for one.
constexpr double least_done = 0.05, smoothing = 0.1;

/// "gravity.acceleration", "pins.0.translate, contact.dhat", "pins.0.translate and 3 more".
std::string first_two(const std::vector<std::string>& names) {
  if (names.size() > 2) return names[0] + " and " + std::to_string(names.size() - 1) + " more";
  return names.empty() ? "" : names[0] + (names.size() == 2 ? ", " + names[1] : "");
}

}  // namespace

Progress::Progress(double tolerance, int levels, Verbosity verbosity, const LoadStepping* load_stepping,
                   const std::vector<std::string>& changing)
    : tolerance_(tolerance),
      levels_(levels),
      verbosity_(verbosity),
      terminal_(isatty(STDERR_FILENO)),
      load_stepping_(load_stepping),
      changing_(first_two(changing)) {}

void Progress::method_started(const std::string& method) { method_ = method; }

void Progress::level_started(int) {
  level_clock_ = Stopwatch();
  last_draw_ = 0;
  first_residual_ = 0;
  done_ = 0;
  to_go_ = 0;
  phase_.clear();
}

void Progress::iteration(const IterationRow& row, const Positions&) {
  take_note(row);
  const double now = level_clock_.seconds();
  if (load_stepping_ && row.time && done_ > least_done)
    to_go_ += (now * (1 - done_) / done_ - to_go_) * (to_go_ > 0 ? smoothing : 1);
  if (verbosity_ == Verbosity::iterations) std::fprintf(stderr, "%s\n", details(row).c_str());
  if (verbosity_ != Verbosity::progress || now - last_draw_ < (terminal_ ? terminal_interval : log_interval))
    return;
  last_draw_ = now;
  draw(row);
}

/// Updates the finished fraction of the level: by the logarithm of the residual towards the tolerance, and
/// under load stepping by increments, the initial equilibrium included.
void Progress::take_note(const IterationRow& row) {
  const bool scheduled = load_stepping_ && row.time;
  const int increment = scheduled ? load_stepping_->increment() : 0,
            last = scheduled ? load_stepping_->increment_count() : 0;
  if (first_residual_ == 0 || increment != increment_) first_residual_ = best_residual_ = row.force_residual;
  increment_ = increment;
  if (std::string phase = scheduled ? load_stepping_->phase() : ""; phase != phase_)
    begin_phase(row, std::move(phase));
  best_residual_ = std::min(best_residual_, row.force_residual);
  const bool is_solved = !scheduled || load_stepping_->equilibrates() || increment == last;
  const double decades = std::log(first_residual_ / tolerance_);
  const double part = decades > 0 ? std::log(first_residual_ / best_residual_) / decades : 1;
  done_ = std::max(done_, (increment + (is_solved ? std::clamp(part, 0.0, 1.0) : 0)) / (last + 1));
}

std::string Progress::line(const IterationRow& row) const {
  constexpr int width = 16;
  std::string bar, increment, to_go;
  for (int k = 0; k < width; ++k) bar += k < done_ * width ? "█" : "░";
  char text[256];
  if (load_stepping_ && row.time) {
    std::snprintf(text, sizeof text, "increment %d/%d of ", increment_, load_stepping_->increment_count());
    increment = text + (phase_.empty() ? changing_ : phase_) + " ";
  }
  if (to_go_ >= 0.5) {
    std::snprintf(text, sizeof text, "  about %.0f s to go", to_go_);
    to_go = text;
  }
  std::snprintf(text, sizeof text, "step %-4d residual %.2e  energy %.6g J", row.step, row.force_residual,
                row.energy);
  const std::string level = "level " + std::to_string(row.level) + "/" + std::to_string(levels_ - 1) + " ";
  return padded(method_, 9) + " " + level + increment + bar + " " + text + to_go;
}

std::string Progress::details(const IterationRow& row) const {
  char text[256];
  std::snprintf(text, sizeof text,
                "level %d/%d step %d iteration %d  residual %.2e  decrement %.2e m/s  energy %.9g J  "
                "step size %.2e s  step length %.2e",
                row.level, levels_ - 1, row.step, row.iteration, row.force_residual, row.decrement,
                row.energy, row.step_size, row.step_length);
  std::string line = method_ + " " + text;
  if (row.contacts) line += "  contacts " + std::to_string(*row.contacts);
  if (row.smallest_gap && std::isfinite(*row.smallest_gap)) {
    std::snprintf(text, sizeof text, "  smallest gap %.2e m", *row.smallest_gap);
    line += text;
  }
  return line;
}

void Progress::draw(const IterationRow& row) {
  clear_line();
  std::fprintf(stderr, "%s%s", line(row).c_str(), terminal_ ? "" : "\n");
  std::fflush(stderr);
  drawn_ = terminal_;
}

void Progress::clear_line() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

/// Writes a line for the phase that has ended, and begins the next.
void Progress::begin_phase(const IterationRow& row, std::string phase) {
  if (verbosity_ != Verbosity::quiet && !phase_.empty()) {
    clear_line();
    std::fprintf(stderr, "%-9s level %d/%d %-12s %5d steps %8.2f s\n", method_.c_str(), row.level,
                 levels_ - 1, phase_.c_str(), row.step - phase_begin_.step,
                 row.seconds - phase_begin_.seconds);
  }
  phase_ = std::move(phase);
  phase_begin_ = row;
}

void Progress::level_finished(const LevelResult& r) {
  if (verbosity_ == Verbosity::quiet) return;
  clear_line();
  std::fprintf(stderr, "%-9s level %d/%d %-12s %5d steps %8.2f s  residual %.2e%s%s\n", method_.c_str(),
               r.level, levels_ - 1, to_string(r.outcome), r.steps, r.seconds, r.force_residual,
               r.message.empty() ? "" : "  ", r.message.c_str());
}

void Progress::method_failed(int level, const std::string& cause) {
  clear_line();
  std::fprintf(stderr, "%-9s level %d/%d %-12s %s\n", method_.c_str(), level, levels_ - 1, "failed",
               printable(cause).c_str());
}

void Progress::not_measured(const std::string& metric, const std::string& cause) {
  clear_line();
  std::fprintf(stderr, "metric %s was not measured: %s\n", metric.c_str(), printable(cause).c_str());
}

}  // namespace drape
