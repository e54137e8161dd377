#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/app/python/callbacks.h"
#include "core/app/run/steered_solve.h"

namespace drape::python {

/// A steered solve that Python advances. While one thread of Python waits for the solver, calls of others
/// raise RuntimeError.
class SolveHandle {
 public:
  explicit SolveHandle(std::unique_ptr<SteeredSolve> solve) : solve_(std::move(solve)) {}
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
  std::shared_ptr<MethodState> checkpoint() {
    require_idle();
    return std::make_shared<MethodState>(solve_->solve().checkpoint());
  }
  std::vector<std::shared_ptr<LevelResult>> levels() {
    require_idle();
    std::vector<std::shared_ptr<LevelResult>> all;
    for (const LevelResult& level : solve_->solve().finished())
      all.push_back(std::make_shared<LevelResult>(level));
    return all;
  }

 private:
  void require_idle() const;

  std::unique_ptr<SteeredSolve> solve_;
  bool busy_ = false;  // guarded by the GIL
};

}  // namespace drape::python
