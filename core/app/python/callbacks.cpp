#include "core/app/python/callbacks.h"

#include <utility>

namespace drape::python {

Callbacks::Callbacks(const py::object& on_iteration, const py::object& on_level) {
  for (const auto& [name, function] : {std::pair{"on_iteration", on_iteration}, {"on_level", on_level}})
    if (!function.is_none() && !PyCallable_Check(function.ptr()))
      throw py::type_error(std::string(name) + " must be a function or None, not " +
                           std::string(py::repr(function)));
  if (!on_iteration.is_none()) on_iteration_ = share(on_iteration);
  if (!on_level.is_none()) on_level_ = share(on_level);
}

template <class Argument>
void Callbacks::call(const SharedObject& function, Argument&& argument) {
  if (!function || stop_) return;
  try {
    with_python([&] {
      const py::object answer = (*function)(std::forward<Argument>(argument));
      if (answer.is_none()) return;
      const std::string word = py::isinstance<py::str>(answer) ? answer.cast<std::string>() : "";
      if (word != "stop" && word != "refine")
        throw py::value_error("a callback must return None, \"stop\" or \"refine\", not " +
                              std::string(py::repr(answer)));
      (word == "stop" ? stop_ : refine_) = true;
    });
  } catch (const std::exception&) {  // raised again at the end of the run, whose results are saved until then
    stop_ = true;
  }
}

void Callbacks::level_started(int) { refine_ = false; }

void Callbacks::iteration(const IterationRow& row, const Positions& x) {
  if (on_iteration_) call(on_iteration_, Iteration{row, std::make_shared<const Positions>(x)});
}

void Callbacks::level_finished(const LevelResult& result) { call(on_level_, result); }

bool Callbacks::stop_requested() {
  if (!stop_) stop_ = has_remembered() || interrupted();
  return stop_;
}

bool Callbacks::refine_requested() { return std::exchange(refine_, false); }

}  // namespace drape::python
