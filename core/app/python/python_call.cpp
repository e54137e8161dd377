#include "core/app/python/python_call.h"

#include <utility>

namespace drape::python {

namespace {

thread_local std::exception_ptr remembered;

}  // namespace

SharedObject share(py::object object) {
  return {new py::object(std::move(object)), [](py::object* held) {
            if (!Py_IsInitialized()) {
              held->release();  // the interpreter and all its objects are gone
            } else {
              const py::gil_scoped_acquire gil;
              *held = py::object();
            }
            delete held;
          }};
}

void remember(std::exception_ptr error) {
  if (!remembered) remembered = std::move(error);
}

void forget_remembered() { remembered = nullptr; }

bool has_remembered() { return remembered != nullptr; }

void rethrow_remembered() {
  if (remembered) std::rethrow_exception(std::exchange(remembered, nullptr));
}

bool interrupted() {
  const py::gil_scoped_acquire gil;
  if (PyErr_CheckSignals() == 0) return false;
  try {
    throw py::error_already_set();
  } catch (const py::error_already_set&) {
    remember(std::current_exception());
  }
  return true;
}

}  // namespace drape::python
