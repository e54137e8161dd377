#pragma once

#include <pybind11/pybind11.h>

#include <memory>

namespace drape::python {

namespace py = pybind11;

/// A Python object that C++ holds: copied and destroyed in any thread, with the GIL or without.
using SharedObject = std::shared_ptr<const py::object>;
SharedObject share(py::object object);

/// A call from C++ into Python, for as long as the object lives. Calls nest, where Python calls C++ that
/// calls Python.
class PythonCall {
 public:
  PythonCall();
  ~PythonCall();
  PythonCall(const PythonCall&) = delete;
  PythonCall& operator=(const PythonCall&) = delete;

  /// Stores the exception in flight, of this thread, unless an earlier one is stored or the call is nested:
  /// then Python may yet handle it. For use in a handler.
  void remember_failure() const;

 private:
  py::gil_scoped_acquire gil_;
};

/// Whether an exception is stored in this thread.
bool has_failed();
void forget_failure();
/// Raises the exception that is stored, if any. Call with the GIL held.
void raise_failure();

/// Calls `body`, which uses Python, from C++ that holds no GIL. An exception goes on through C++, where a run
/// turns it into the failure of a method; it is stored too, so that the binding can raise it.
template <class Body>
auto with_python(const Body& body) {
  const PythonCall call;
  try {
    return body();
  } catch (...) {
    call.remember_failure();
    throw;
  }
}

/// The result of `body`, which runs without the GIL: it takes long, or calls prototypes, which take it
/// themselves.
template <class Body>
auto without_gil(const Body& body) {
  const py::gil_scoped_release released;
  return body();
}

}  // namespace drape::python
