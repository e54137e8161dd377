#pragma once

#include <memory>
#include <string>

#include "core/app/experiment/experiment.h"
#include "core/numerics/solve/stepped_solve.h"

namespace drape {

/// One method of an experiment, advanced an iteration at a time; parameters of the experiment may change in
/// between. Nothing is recorded.
class SteeredSolve {
 public:
  /// Builds the experiment of `source` (a map as read_yaml gives it) and its scene. `method` is the name of
  /// one, or empty for the default. `from` is a state of the same experiment and method to resume from. Null,
  /// with every error appended, if the experiment is not valid. Throws std::runtime_error for an unknown
  /// method.
  static std::unique_ptr<SteeredSolve> begin(ConfigNode source, const std::string& method,
                                             const Registry& registry, ConfigErrors& errors,
                                             MethodState from = {});

  /// The solve since the last change of a parameter: its rows, state and levels.
  SteppedSolve& solve() { return *solve_; }
  const std::shared_ptr<const Experiment>& experiment() const { return experiment_; }
  const std::shared_ptr<const Scene>& scene() const { return scene_; }
  const std::string& method() const { return method_; }

  /// Changes one value, as `drape run --resume --set` does, and goes on from the present state on its level:
  /// Dirichlet vertices move from there to their targets. Returns false, with errors appended and nothing
  /// changed, if the value is refused or the state does not fit it. Several changes in a row go on from the
  /// same state. Throws std::runtime_error before the first iteration, and if the method's solver cannot go
  /// on from a finer level.
  bool set(const std::string& key, const std::string& value, ConfigErrors& errors);

 private:
  SteeredSolve() = default;

  std::string method_;
  int level_ = -1;  // of the last change; -1 before the first
  std::shared_ptr<const Experiment> experiment_;
  std::shared_ptr<const Scene> scene_;
  std::unique_ptr<SteppedSolve> solve_;  // last: it refers to the others
};

}  // namespace drape
