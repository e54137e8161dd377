#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/app/experiment/experiment_path.h"
#include "core/app/experiment/method_choice.h"
#include "core/app/experiment/plausibility.h"
#include "core/app/experiment/size_estimate.h"
#include "core/app/files/yaml_file.h"
#include "core/app/python/callbacks.h"
#include "core/app/python/config_value.h"
#include "core/app/python/module.h"
#include "core/app/python/registry.h"
#include "core/app/python/run_store.h"
#include "core/app/python/scene_handle.h"
#include "core/app/python/solve_handle.h"
#include "core/app/run/runner.h"

namespace drape::python {

namespace {

/// An experiment as written; it is read anew whenever it is used.
class ExperimentHandle {
 public:
  explicit ExperimentHandle(ConfigNode source) : source_(std::move(source)) {}

  static ExperimentHandle of_file(const std::filesystem::path& file) {
    ConfigErrors errors;
    ConfigNode source = read_yaml(file, errors);
    throw_errors(errors);
    return ExperimentHandle(std::move(source));
  }

  void set(const std::string& key, const py::object& value) {
    ConfigErrors errors;
    ConfigNode changed = source_;
    if (py::isinstance<py::str>(value))
      set_parameter(changed, key, value.cast<std::string>(), "--set " + key, errors);
    else
      set_parameter(changed, key, node_of(value), Location{"--set " + key, 0, 0}, errors);
    throw_errors(errors);
    source_ = std::move(changed);
  }

  const ConfigNode& source() const { return source_; }

  std::shared_ptr<const Experiment> read() const {
    ConfigErrors errors;
    auto experiment = read_experiment(source_, registry(), errors);
    throw_errors(errors);
    return std::make_shared<const Experiment>(std::move(*experiment));
  }

  SceneHandle scene(bool allow_memory) const {
    const auto experiment = read();
    const LargeMemory large = allow_memory ? LargeMemory::allowed : LargeMemory::refused;
    ConfigErrors errors;
    std::shared_ptr<const Scene> scene;
    {
      const py::gil_scoped_release released;  // building may call prototypes
      refuse_too_large(*experiment, large, errors);
      if (errors.empty()) scene = build_scene(*experiment, errors);
    }
    throw_errors(errors);
    return {experiment, scene};
  }

 private:
  ConfigNode source_;
};

/// Issues a UserWarning for everything about the scene that no fabric has.
void warn_of_implausible(const SceneHandle& s) {
  ConfigErrors warnings;
  {
    const py::gil_scoped_release released;  // binding energies may call prototypes
    warnings = plausibility_warnings(*s.experiment, *s.scene, summary_of(*s.scene));
  }
  for (const ConfigError& warning : warnings)
    if (PyErr_WarnEx(PyExc_UserWarning, warning.text().c_str(), 1) != 0) throw py::error_already_set();
}

std::shared_ptr<RunStore> run(const ExperimentHandle& handle,
                              const std::optional<std::vector<std::string>>& methods,
                              const std::optional<std::filesystem::path>& out, const py::object& on_iteration,
                              const py::object& on_level, bool progress, bool report, bool overwrite,
                              bool allow_memory) {
  Callbacks callbacks(on_iteration, on_level);
  const SceneHandle scene = handle.scene(allow_memory);
  warn_of_implausible(scene);
  const auto folder =
      out ? std::make_shared<const RunFolderHandle>(*out) : std::make_shared<const RunFolderHandle>();
  RunOptions options;
  options.out = folder->path();
  options.methods = chosen_methods(*scene.experiment, methods.value_or(std::vector<std::string>()));
  options.overwrite = overwrite;
  options.verbosity = progress ? Verbosity::progress : Verbosity::quiet;
  options.report = report && out;
  options.stop = [&] { return callbacks.stop_requested(); };  // of solves that are not observed too
  options.observer = &callbacks;
  forget_failure();
  std::exception_ptr error;
  {
    const py::gil_scoped_release released;
    try {
      run_experiment(*scene.experiment, *scene.scene, options);
    } catch (...) {
      error = std::current_exception();
    }
  }
  // First the causes of what follows from them.
  callbacks.raise_error();
  raise_failure();
  if (error) std::rethrow_exception(error);
  return std::make_shared<RunStore>(folder);
}

std::unique_ptr<SolveHandle> solver(const ExperimentHandle& handle, const std::string& method,
                                    const std::shared_ptr<CheckpointHandle>& start) {
  ConfigErrors errors;
  std::unique_ptr<SteeredSolve> solve;
  const Registry& plugins = registry();
  {
    const py::gil_scoped_release released;
    solve =
        SteeredSolve::begin(handle.source(), method, plugins, errors, start ? start->state : MethodState());
  }
  throw_errors(errors);
  if (start) start->require_fitting(*solve);
  return std::make_unique<SolveHandle>(std::move(solve));
}

}  // namespace

void bind_experiment(py::module_& m) {
  py::class_<ExperimentHandle>(m, "ExperimentBase", "See drape.Experiment.")
      .def(py::init([](const py::object& source) {
             if (py::isinstance<py::dict>(source)) return ExperimentHandle(node_of(source));
             if (py::isinstance<py::str>(source) || py::hasattr(source, "__fspath__"))
               return ExperimentHandle::of_file(source.cast<std::filesystem::path>());
             throw py::type_error("an experiment is the path of a YAML file or a dict, not " +
                                  std::string(py::repr(source)));
           }),
           py::arg("source"))
      .def("set", &ExperimentHandle::set, py::arg("key"), py::arg("value"),
           "Override one value, as `drape run --set KEY=VALUE` does; a str is read as YAML. Raises "
           "ConfigError for a path that is none. The key and the value are checked by `check` and `run`.")
      .def(
          "check",
          [](const ExperimentHandle& e, bool allow_memory) {
            const SceneHandle s = e.scene(allow_memory);
            warn_of_implausible(s);
            ConfigErrors errors;
            {
              const py::gil_scoped_release released;  // evaluating may call prototypes
              refuse_infinite_energies(*s.experiment, *s.scene, errors);
            }
            throw_errors(errors);
          },
          py::arg("allow_memory") = false,
          "Validate the experiment without running it, and evaluate its energies at the start. Raises "
          "ConfigError with every fault and its file, line and column. Warns of what no fabric has, as `run` "
          "does.")
      .def_property_readonly(
          "resolved", [](const ExperimentHandle& e) { return value_of(e.read()->resolved); },
          "The experiment as a dict with every parameter of every plugin.")
      .def_property_readonly("methods",
                             [](const ExperimentHandle& e) {
                               std::vector<std::string> names;
                               const auto experiment = e.read();  // which lives through the loop
                               for (const auto& [name, solver] : experiment->methods) names.push_back(name);
                               return names;
                             })
      .def("scene", &ExperimentHandle::scene, py::arg("allow_memory") = false,
           "The levels, models and initial states. Raises ConfigError.")
      .def("solver", &solver, py::arg("method") = "", py::arg("start") = nullptr,
           "A Solve of one method, to be advanced step by step; by default pcs, or the only method. `start` "
           "is "
           "a Checkpoint of the same experiment and method. Raises ConfigError, and RuntimeError for another "
           "experiment's checkpoint.")
      .def("_run", &run, py::arg("methods"), py::arg("out"), py::arg("on_iteration"), py::arg("on_level"),
           py::arg("progress"), py::arg("report"), py::arg("overwrite"), py::arg("allow_memory"));
}

}  // namespace drape::python
