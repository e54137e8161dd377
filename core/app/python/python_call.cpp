#include <unistd.h>

#include <chrono>
#include <exception>
#include <string>
#include <thread>
#include <utility>

#include "core/app/python/module.h"

namespace drape::python {

namespace {

// The Python exception itself, since a py::error_already_set can be raised only once.
thread_local SharedObject raised;
thread_local std::exception_ptr thrown;

thread_local int depth = 0;  // of calls

const pid_t own_process = getpid();

SharedObject exception_of(const py::error_already_set& error) {
  py::object value = error.value();
  if (error.trace()) PyException_SetTraceback(value.ptr(), error.trace().ptr());
  return share(std::move(value));
}

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

bool has_failed() { return raised || thrown; }

void raise_failure() {
  if (const SharedObject exception = std::exchange(raised, nullptr)) {
    PyErr_SetObject(py::type::of(*exception).ptr(), exception->ptr());
    throw py::error_already_set();
  }
  if (thrown) std::rethrow_exception(std::exchange(thrown, nullptr));
}

void WithoutGil::wait_for_all() {
  to_end_ = true;
  while (Counted::under_way > 0 && getpid() == own_process) {  // the child of a fork has no other thread
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    const py::gil_scoped_release released;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

void WithoutGil::refuse_after_end() {
  if (to_end_ && Counted::under_way == 0)
    throw std::runtime_error("the interpreter ends; nothing more can be run");
}

OwnCalls::OwnCalls() : outer_(std::exchange(depth, 0)) {
  raised = nullptr;
  thrown = nullptr;
}
OwnCalls::~OwnCalls() { depth = outer_; }

PythonCall::PythonCall() { ++depth; }
PythonCall::~PythonCall() { --depth; }

void PythonCall::remember_failure() const {
  if (depth > 1 || has_failed()) return;
  try {
    throw;
  } catch (const py::error_already_set& error) {
    raised = exception_of(error);
  } catch (const py::cast_error& error) {
    thrown = std::make_exception_ptr(
        py::type_error(std::string("a prototype returned a value of the wrong type: ") + error.what()));
  } catch (...) {
    thrown = std::current_exception();
  }
}

}  // namespace drape::python
