#pragma once

#include "core/app/python/level_handle.h"
#include "core/app/python/python_call.h"
#include "core/kernel/interfaces/solver.h"
#include "core/kernel/threads/stopwatch.h"

namespace drape::python {

/// What a solver in Python works on, and how it reports. Usable until its solve ends; then every call raises
/// RuntimeError. Used with the GIL held, which its reports release.
class SolverProblem {
 public:
  SolverProblem(const Problem& problem, Observer& observer) : problem_(&problem), observer_(&observer) {}

  int level_count() const { return static_cast<int>(problem().models.size()); }
  ModelHandle model(int level) const;
  Positions start(int level) const { return problem().starts.at(checked(level)); }
  /// A level's state on the next one, by linear interpolation over the rest shape.
  Positions prolong(int level, const Positions& x) const;

  /// Raises ValueError unless the level is finer than those that have ended.
  void begin(int level);
  /// Vertices of the level that has begun. Throws std::runtime_error without one.
  int vertex_count() const;
  /// x is vertex_count()×3 and finite, or ValueError is raised. Returns whether to go on: false after a
  /// request to stop.
  bool iteration(const Positions& x, std::optional<double> energy, std::optional<double> force_residual,
                 double step_length);
  void end(const Positions& x, const std::string& status, const std::string& message);

  /// Ends the solve, whatever it has reported.
  void expire();
  /// The same, and returns the results of the levels that ended. Raises ValueError if none has, or one has
  /// begun and not ended.
  std::vector<LevelResult> finish();

 private:
  const Problem& problem() const;
  int checked(int level) const;

  const Problem* problem_;
  Observer* observer_;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
  const Stopwatch clock_;
  std::optional<LevelResult> under_way_;
  double began_ = 0;
  std::vector<LevelResult> results_;
};

/// A solver that a Python object runs: see drape.Solver. Without schedules and checkpoints.
class PythonSolver final : public Solver {
 public:
  explicit PythonSolver(py::object prototype) : prototype_(share(std::move(prototype))) {}
  std::vector<LevelResult> solve(const Problem& problem, Observer& observer) const override;

 private:
  SharedObject prototype_;
};

}  // namespace drape::python
