#pragma once

#include <exception>
#include <memory>

#include "core/app/python/python_call.h"
#include "core/kernel/interfaces/solver.h"

namespace drape::python {

/// An iteration and its state, which Python may keep.
struct Iteration {
  IterationRow row;
  std::shared_ptr<const Positions> x;
};

/// Passes a run's events on to Python's functions, and Python's wishes to the run: an exception of a function
/// or a prototype, Ctrl-C and a returned "stop" stop it, a returned "refine" ends the level. Used without the
/// GIL.
class Callbacks : public Observer {
 public:
  /// Functions of an Iteration and of a LevelResult; None for none.
  Callbacks(const py::object& on_iteration, const py::object& on_level);

  void level_started(int level) override;
  void iteration(const IterationRow& row, const Positions& x) override;
  void level_finished(const LevelResult& result) override;
  bool stop_requested() override;
  bool refine_requested() override;

  /// Raises what a function or a signal's handler raised, if any. Call with the GIL held, at the end.
  void raise_error();

 private:
  /// Calls the function. After an exception the run stops.
  template <class Argument>
  void call(const SharedObject& function, Argument&& argument);

  SharedObject on_iteration_, on_level_;  // null for none
  bool stop_ = false, refine_ = false;
  std::exception_ptr error_;
};

}  // namespace drape::python
