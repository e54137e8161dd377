#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/app/python/arrays.h"
#include "core/app/python/module.h"
#include "core/app/python/run_store.h"
#include "core/app/report/report.h"
#include "core/app/report/run_table.h"
#include "core/app/view/colours.h"

namespace drape::python {

namespace {

/// A method of a run, and one of its levels.
struct MethodHandle {
  std::shared_ptr<const RunStore> run;
  const MethodRecord* record;
};
struct LevelRecordHandle {
  std::shared_ptr<const RunStore> run;
  const LevelRecord* record;
};

py::dict dict_of(const NamedNumbers& numbers) {
  py::dict all;
  for (const auto& [name, value] : numbers) all[py::str(name)] = value;
  return all;
}

template <class Member>
auto of_level(Member LevelRecord::*member) {
  return [member](const LevelRecordHandle& l) { return l.record->*member; };
}

/// A column as an int, or None.
auto count_of_level(OptionalNumber LevelRecord::*member) {
  return [member](const LevelRecordHandle& l) -> std::optional<long> {
    const OptionalNumber& number = l.record->*member;
    return number ? std::optional<long>(static_cast<long>(*number)) : std::nullopt;
  };
}

void bind_level_record(py::module_& m) {
  py::class_<LevelRecordHandle>(m, "LevelRecord", "The last state of one level of one method of a run.")
      .def_property_readonly("level", of_level(&LevelRecord::level))
      .def_property_readonly("status", of_level(&LevelRecord::status))
      .def_property_readonly("message", of_level(&LevelRecord::message))
      .def_property_readonly("vertices", count_of_level(&LevelRecord::vertices))
      .def_property_readonly("steps", count_of_level(&LevelRecord::steps))
      .def_property_readonly("iterations", count_of_level(&LevelRecord::iterations))
      .def_property_readonly("seconds", of_level(&LevelRecord::seconds))
      .def_property_readonly("energy", of_level(&LevelRecord::energy), "[J]")
      .def_property_readonly(
          "energy_on_finest", of_level(&LevelRecord::energy_on_finest),
          "The finest level's energy, without contact and strain limits, at the prolonged state [J].")
      .def_property_readonly("energy_released", of_level(&LevelRecord::energy_released),
                             "How far that energy has fallen since the scene's start [J].")
      .def_property_readonly("force_residual", of_level(&LevelRecord::force_residual), "[1]")
      .def_property_readonly("intersections", count_of_level(&LevelRecord::intersections))
      .def_property_readonly("smallest_gap", of_level(&LevelRecord::smallest_gap), "[m]")
      .def_property_readonly("energy_parts",
                             [](const LevelRecordHandle& l) { return dict_of(l.record->energy_parts); })
      .def_property_readonly("seconds_by_phase",
                             [](const LevelRecordHandle& l) { return dict_of(l.record->seconds_by_phase); })
      .def_property_readonly(
          "metrics",
          [](const LevelRecordHandle& l) { return std::map<std::string, double>(l.record->metrics); },
          "Values of the state metrics by name.")
      .def_property_readonly(
          "x",
          [](const LevelRecordHandle& l) {
            const auto mesh = l.run->mesh(l.record->mesh);
            return view(mesh->vertices, mesh);
          },
          "n×3 positions [m], read-only.")
      .def_property_readonly(
          "triangles",
          [](const LevelRecordHandle& l) {
            const auto mesh = l.run->mesh(l.record->mesh);
            return view(mesh->triangles, mesh);
          },
          "m×3 vertex indices, read-only.");
}

void bind_method_record(py::module_& m) {
  py::class_<MethodHandle>(m, "MethodRecord", "One method of a run.")
      .def_property_readonly("name", [](const MethodHandle& h) { return h.record->name; })
      .def_property_readonly("status", [](const MethodHandle& h) { return h.record->status; })
      .def_property_readonly("solver", [](const MethodHandle& h) { return h.record->solver; })
      .def_property_readonly(
          "_style", [](const MethodHandle& h) { return solver_style(h.record->solver); },
          "Index of the colour and the mark that its solver has in every plot.")
      .def_property_readonly("seconds", [](const MethodHandle& h) { return h.record->seconds; })
      .def_property_readonly("peak_memory_bytes",
                             [](const MethodHandle& h) { return h.record->peak_memory_bytes; })
      .def_property_readonly(
          "levels",
          [](const MethodHandle& h) {
            std::vector<LevelRecordHandle> all;
            for (const LevelRecord& level : h.record->levels) all.push_back({h.run, &level});
            return all;
          },
          "The levels that the method reached, coarse to fine.");
}

MethodHandle method_of(const std::shared_ptr<RunStore>& run, const std::string& name) {
  for (const MethodRecord& method : run->data.methods)
    if (method.name == name) return {run, &method};
  throw py::key_error("the run has no method \"" + name + "\"");
}

}  // namespace

void bind_result(py::module_& m) {
  bind_level_record(m);
  bind_method_record(m);
  m.def(
      "_table",
      [](const std::filesystem::path& folder) {
        return table_text(table_of(read_runs({folder})), {}, TableFormat::json);
      },
      py::arg("folder"), "The rows of `drape table FOLDER --format json`.");
  py::class_<RunStore, std::shared_ptr<RunStore>>(
      m, "RunRecord", "What a run has written: result[\"pcs\"].levels[-1].x is the finest state of a method.")
      .def(py::init([](const std::filesystem::path& folder) {
             return std::make_shared<RunStore>(std::make_shared<const RunFolderHandle>(folder));
           }),
           py::arg("folder"),
           "Read the results folder of a run, finished or interrupted. Raises RuntimeError if it holds none.")
      .def_property_readonly("folder", [](const RunStore& r) { return r.data.folder.string(); })
      .def_property_readonly("experiment", [](const RunStore& r) { return r.data.experiment; })
      .def_property_readonly("complete", [](const RunStore& r) { return r.data.complete; })
      .def_property_readonly("reference", [](const RunStore& r) { return r.data.reference; })
      .def_property_readonly("methods",
                             [](const RunStore& r) {
                               std::vector<std::string> names;
                               for (const MethodRecord& method : r.data.methods) names.push_back(method.name);
                               return names;
                             })
      .def("__getitem__", &method_of, py::arg("method"))
      .def("__len__", [](const RunStore& r) { return r.data.methods.size(); })
      .def(
          "page", [](const RunStore& r) { return viewer_page(r.data); },
          "An HTML page with the report's 3D viewer of every state.");
}

}  // namespace drape::python
