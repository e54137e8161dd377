#include "core/numerics/solve/stepped_solve.h"

#include <stdexcept>
#include <utility>

namespace drape {

SteppedSolve::SteppedSolve(const Solver& solver, const Problem& problem, MethodState from)
    : solver_(solver),
      problem_(problem),
      from_(std::move(from)),
      clock_(from_.seconds),
      finished_(from_.finished),
      checkpoint_(from_) {
  const bool from_beginning = from_.finished.empty() && from_.level == 0 && !from_.under_way;
  if (!from_beginning && !solver.can_resume())
    throw std::runtime_error("the solver cannot go on from a state; start it at the beginning");
}

SteppedSolve::~SteppedSolve() {
  if (!thread_.joinable()) return;
  stop_ = true;
  try {
    while (advance()) {
    }
  } catch (...) {  // nobody is left who could be told
  }
  thread_.join();
}

bool SteppedSolve::advance() {
  if (turn_ == Turn::ended) return false;
  std::unique_lock<std::mutex> lock(mutex_);
  turn_ = Turn::solver;
  if (thread_.joinable())
    changed_.notify_all();
  else
    thread_ = std::thread([this] { run(); });
  changed_.wait(lock, [this] { return turn_ != Turn::solver; });
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  return turn_ == Turn::caller;
}

void SteppedSolve::run() {
  std::exception_ptr error;
  try {
    solver_.resume(problem_, from_, *this);
  } catch (...) {
    error = std::current_exception();
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  error_ = std::move(error);  // the caller alone owns it from here on
  turn_ = Turn::ended;
  changed_.notify_all();
}

void SteppedSolve::hand_over() {
  std::unique_lock<std::mutex> lock(mutex_);
  turn_ = Turn::caller;
  changed_.notify_all();
  changed_.wait(lock, [this] { return turn_ == Turn::solver; });
}

void SteppedSolve::level_started(int) { refine_ = false; }

void SteppedSolve::iteration(const IterationRow& row, const Positions& x) {
  row_ = row;
  x_ = x;
  hand_over();
}

void SteppedSolve::level_finished(const LevelResult& result) {
  finished_.push_back(result);
  if (result.outcome == Outcome::cancelled) return;  // its checkpoint stays, to be resumed
  checkpoint_ = {finished_, result.level + 1, std::nullopt, clock_.seconds()};
}

bool SteppedSolve::refine_requested() { return std::exchange(refine_, false); }

void SteppedSolve::checkpoint(const NewtonState& state) {
  checkpoint_.level = state.so_far.level;
  checkpoint_.under_way = state;
  checkpoint_.seconds = clock_.seconds();
}

}  // namespace drape
