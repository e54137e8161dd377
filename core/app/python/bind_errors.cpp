#include "core/app/python/module.h"
#include "core/app/run/runner.h"

namespace drape::python {

void bind_errors(py::module_& m) {
  // Errors of a config are raised by throw_errors.
  py::register_exception<RunAborted>(m, "RunAborted", PyExc_RuntimeError).attr("__doc__") =
      "A run was aborted after it had begun, as on a full disk; its message says what to do.";
  // Local: other modules that are built with pybind11 keep their own translation.
  py::register_local_exception_translator([](std::exception_ptr error) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (const std::logic_error& fault) {
      PyErr_SetString(PyExc_ValueError, fault.what());
    }
  });
}

}  // namespace drape::python
