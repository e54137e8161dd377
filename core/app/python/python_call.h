#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <memory>

namespace drape::python {

namespace py = pybind11;

/// A Python object that C++ holds: copied and destroyed in any thread, with the GIL or without.
using SharedObject = std::shared_ptr<const py::object>;
SharedObject share(py::object object);

/// Remembers a Python exception of this thread, the first one, until rethrow_remembered.
void remember(std::exception_ptr error);
/// Forgets it, before a call that may remember one.
void forget_remembered();
bool has_remembered();
/// Throws it, if there is one. Call with the GIL held.
void rethrow_remembered();

/// Calls `body`, which uses Python, from C++ that holds no GIL. A Python exception goes on through C++. A run
/// turns it into the failure of a method; it is remembered too, so that the binding can raise it.
template <class Body>
auto with_python(const Body& body) {
  const py::gil_scoped_acquire gil;
  try {
    return body();
  } catch (const py::error_already_set&) {
    remember(std::current_exception());
    throw;
  } catch (const py::cast_error& error) {
    const auto message = std::string("a prototype returned a value of the wrong type: ") + error.what();
    auto as_type_error = std::make_exception_ptr(py::type_error(message));
    remember(as_type_error);
    std::rethrow_exception(as_type_error);
  } catch (const std::exception&) {  // what the binding says of a value that Python returned
    remember(std::current_exception());
    throw;
  }
}

/// Whether a signal's handler has raised an exception, such as KeyboardInterrupt; it is then remembered.
bool interrupted();

}  // namespace drape::python
