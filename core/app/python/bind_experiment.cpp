#include "core/app/experiment/cloth.h"
#include "core/app/files/yaml_file.h"
#include "core/app/python/module.h"
#include "core/app/python/values.h"
#include "core/app/scene/scene_summary.h"
#include "core/app/setup/build_scene.h"

namespace drape::python {

namespace {

ExperimentHandle experiment_of(const py::object& source) {
  if (py::isinstance<py::dict>(source)) return {node_of(source)};
  if (!py::isinstance<py::str>(source) && !py::hasattr(source, "__fspath__"))
    throw py::type_error("an experiment is the path of a YAML file or a dict, not " + shown(source));
  ConfigErrors errors;
  ExperimentHandle experiment{read_yaml(source.cast<std::filesystem::path>(), errors)};
  throw_errors(errors);
  return experiment;
}

void check(const ExperimentHandle& e, bool allow_memory) {
  const SceneHandle s = e.scene(allow_memory);
  warn_of_implausible(s);
  ConfigErrors errors;
  without_gil([&] { refuse_infinite_energies(*s.experiment, *s.scene, errors); });
  throw_errors(errors);
}

/// Faults elsewhere are left to `check`: a value that is set next may mend them.
void set(ExperimentHandle& e, const Text& key, const py::object& value) {
  ConfigNode changed = with_value(e.source, key, value);
  ConfigErrors errors;
  read_experiment(changed, registry(), errors);
  std::erase_if(errors, [&](const ConfigError& error) { return error.where.file != option_of(key); });
  throw_errors(errors);
  e.source = std::move(changed);
}

}  // namespace

std::shared_ptr<const Experiment> ExperimentHandle::read(LargeMemory large) const {
  ConfigErrors errors;
  auto experiment = read_experiment(source, registry(), errors, large);
  throw_errors(errors);
  return std::make_shared<const Experiment>(std::move(*experiment));
}

SceneHandle ExperimentHandle::scene(bool allow_memory) const {
  const LargeMemory large = allow_memory ? LargeMemory::allowed : LargeMemory::refused;
  const auto experiment = read(large);
  ConfigErrors errors;
  std::shared_ptr<const Scene> scene;
  without_gil([&] { scene = build_scene(*experiment, errors, large); });
  throw_errors(errors);
  return {experiment, scene};
}

void warn_of_implausible(const SceneHandle& s) {
  const ConfigErrors warnings =
      without_gil([&] { return plausibility_warnings(*s.experiment, *s.scene, summary_of(*s.scene)); });
  for (const ConfigError& warning : warnings) warn(warning.text());
}

void bind_experiment(py::module_& m) {
  py::class_<ExperimentHandle>(m, "ExperimentBase", "See drape.Experiment.")
      .def(py::init(&experiment_of), py::arg("source"))
      .def("set", &set, py::arg("key"), py::arg("value"),
           "Override one value, as `drape run --set KEY=VALUE` does; a str is read as YAML. Raises "
           "ConfigError, with nothing changed, for an unknown key or a value that it cannot have. What the "
           "value makes faulty elsewhere is left to `check` and `run`.")
      .def(
          "check", &check, py::arg("allow_memory") = false,
          "Validate the experiment without running it, and evaluate its energies at the start. Raises "
          "ConfigError with every fault and its file, line and column. Warns of what no fabric has, as `run` "
          "does.")
      .def_property_readonly(
          "resolved", [](const ExperimentHandle& e) { return value_of(e.read()->resolved); },
          "A copy of the experiment as a dict with every parameter of every plugin; `set` changes one.")
      .def_property_readonly("methods", [](const ExperimentHandle& e) { return e.read()->method_names(); })
      .def("scene", &ExperimentHandle::scene, py::arg("allow_memory") = false,
           "The levels, models and initial states. Raises ConfigError.");
}

}  // namespace drape::python
