#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/app/python/callbacks.h"
#include "core/app/run/steered_solve.h"

namespace drape::python {

/// A state to resume from, and what it is a state of.
struct CheckpointHandle {
  MethodState state;
  std::string method;
  std::string experiment;  ///< resolved, as text

  /// Throws std::runtime_error unless the solve has the same method and experiment.
  void require_fitting(const SteeredSolve& solve) const {
    if (solve.method() != method)
      throw std::runtime_error("the checkpoint is one of the method " + method + ", not of " +
                               solve.method());
    if (solve.experiment()->resolved.one_line() != experiment)
      throw std::runtime_error(
          "the checkpoint is one of an experiment with other values; set them back, or use "
          "Solve.set to change them during a solve");
  }
};

/// Ends every solve, for the interpreter's exit: a prototype's solver cannot take the GIL any more after it.
void end_all_solves();

/// A steered solve that Python advances. While one thread of Python waits for the solver, calls of others
/// raise RuntimeError.
class SolveHandle {
 public:
  explicit SolveHandle(std::unique_ptr<SteeredSolve> solve);
  ~SolveHandle();
  SolveHandle(const SolveHandle&) = delete;
  SolveHandle& operator=(const SolveHandle&) = delete;

  const SteeredSolve& steered() const {
    require_idle();
    return *solve_;
  }
  /// The next iteration; empty at the end.
  std::optional<Iteration> next();
  void set(const std::string& key, const std::string& value);
  void stop() {
    require_idle();
    solve_->solve().stop();
  }
  void refine() {
    require_idle();
    solve_->solve().refine();
  }
  std::shared_ptr<CheckpointHandle> checkpoint() {
    require_idle();
    return std::make_shared<CheckpointHandle>(CheckpointHandle{solve_->solve().checkpoint(), solve_->method(),
                                                               solve_->experiment()->resolved.one_line()});
  }
  std::vector<std::shared_ptr<LevelResult>> levels() {
    require_idle();
    std::vector<std::shared_ptr<LevelResult>> all;
    for (const LevelResult& level : solve_->solve().finished())
      all.push_back(std::make_shared<LevelResult>(level));
    return all;
  }

  /// Ends the solve; every later call raises RuntimeError.
  void end();

 private:
  /// Throws std::runtime_error while the solve is being advanced, and once it has been ended.
  void require_idle() const;

  std::unique_ptr<SteeredSolve> solve_;
  bool busy_ = false;  // guarded by the GIL
};

}  // namespace drape::python
