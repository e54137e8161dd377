#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <type_traits>

namespace drape::python {

namespace py = pybind11;

/// A Python object that C++ holds: copied and destroyed in any thread, with the GIL or without.
using SharedObject = std::shared_ptr<const py::object>;
SharedObject share(py::object object);

/// Whether a call of with_python in this thread has failed since forget_failure.
bool has_failed();
void forget_failure();
/// Raises what the first call that failed raised. Call with the GIL held.
void raise_failure();

/// Stores the exception in flight for raise_failure. Call with the GIL held, from a handler.
void remember_failure();

/// Calls `body`, which uses Python, from C++ that holds no GIL. An exception goes on through C++, where a run
/// turns it into the failure of a method; it is stored too, so that the binding can raise it. What fails
/// inside a body that ends well has been handled in Python, and is forgotten.
template <class Body>
auto with_python(const Body& body) {
  const py::gil_scoped_acquire gil;
  const bool failed_before = has_failed();
  try {
    if constexpr (std::is_void_v<decltype(body())>) {
      body();
      if (!failed_before) forget_failure();
    } else {
      auto result = body();
      if (!failed_before) forget_failure();
      return result;
    }
  } catch (...) {
    remember_failure();
    throw;
  }
}

}  // namespace drape::python
