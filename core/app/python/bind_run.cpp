#include <exception>
#include <utility>

#include "core/app/experiment/experiment.h"
#include "core/app/python/module.h"
#include "core/app/python/values.h"
#include "core/app/report/report.h"
#include "core/app/report/run_export.h"
#include "core/app/report/run_table.h"
#include "core/app/run/runner.h"
#include "core/app/run/saved_run.h"
#include "core/app/view/page.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/number_text.h"

namespace drape::python {

namespace {

namespace fs = std::filesystem;

/// Passes a run's events on to Python's functions, and Python's wishes to the run: an exception of a function
/// or a prototype, Ctrl-C and a returned "stop" stop it, a returned "refine" ends the level. Used without the
/// GIL.
class Callbacks : public Observer {
 public:
  /// Functions of an Iteration and of a MethodLevelResult; None for none.
  Callbacks(const py::object& on_iteration, const py::object& on_level)
      : on_iteration_(function("on_iteration", on_iteration)), on_level_(function("on_level", on_level)) {}

  void method_started(const std::string& method) { method_ = method; }
  void level_started(int) override { refine_ = false; }
  void iteration(const IterationRow& row, const Positions& x) override {
    if (on_iteration_) call(on_iteration_, Iteration{row, x, method_});
  }
  void level_finished(const LevelResult& result) override {
    call(on_level_, MethodLevelResult{result, method_});
  }
  bool refine_requested() override { return std::exchange(refine_, false); }

  bool stop_requested() override {
    if (has_failed() || WithoutGil::to_end()) stop_ = true;
    if (stop_) return true;
    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() == 0) return false;
    error_ = std::make_exception_ptr(py::error_already_set());  // takes KeyboardInterrupt or what else is set
    stop_ = true;
    return true;
  }

  /// Raises what a function or a signal's handler raised, if any. Call with the GIL held, at the end.
  void raise_error() {
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  }

 private:
  static SharedObject function(const char* name, const py::object& given) {
    if (given.is_none()) return nullptr;
    if (!PyCallable_Check(given.ptr()))
      throw py::type_error(std::string(name) + " must be a function or None, not " + shown(given));
    return share(given);
  }

  /// After an exception the run stops.
  template <class Argument>
  void call(const SharedObject& function, const Argument& argument) {
    if (!function || stop_) return;
    const PythonCall nesting;  // what the function itself calls may fail, and be handled there
    try {
      const py::object answer = (*function)(argument);
      const std::string word = py::isinstance<py::str>(answer) ? answer.cast<std::string>() : "";
      if (word == "stop")
        stop_ = true;
      else if (word == "refine")
        refine_ = true;
      else if (!answer.is_none())
        throw py::value_error("a callback must return None, \"stop\" or \"refine\", not " + shown(answer));
    } catch (const std::exception&) {  // raised at the end of the run, whose results are saved until then
      error_ = std::current_exception();
      stop_ = true;
    }
  }

  SharedObject on_iteration_, on_level_;  // null for none
  std::string method_;
  bool stop_ = false, refine_ = false;
  std::exception_ptr error_;
};

/// Runs `action` with the callbacks and without the GIL, and raises what a function or a prototype raised.
template <class Action>
void observed(Callbacks& callbacks, RunOptions options, const Action& action) {
  options.stop = [&] { return callbacks.stop_requested(); };  // of solves that are not observed too
  options.method_started = [&](const std::string& method) { callbacks.method_started(method); };
  options.observer = &callbacks;
  std::exception_ptr error;
  without_gil([&] {
    const OwnCalls calls;
    try {
      action(options);
    } catch (...) {
      error = std::current_exception();
    }
  });
  // First the causes of what follows from them.
  callbacks.raise_error();
  raise_failure();
  if (error) std::rethrow_exception(error);
}

RunOptions options_of(const fs::path& out, bool progress, bool report) {
  RunOptions options;
  options.out = out;
  options.verbosity = progress ? Verbosity::progress : Verbosity::quiet;
  options.report = report;
  return options;
}

void run(const ExperimentHandle& handle, const std::vector<Text>& methods, const fs::path& out,
         const py::object& on_iteration, const py::object& on_level, bool progress, bool report,
         bool overwrite, bool allow_memory) {
  Callbacks callbacks(on_iteration, on_level);
  const SceneHandle scene = handle.scene(allow_memory);
  warn_of_implausible(scene);
  RunOptions options = options_of(out, progress, report);
  options.methods = chosen_methods(*scene.experiment, {methods.begin(), methods.end()});
  options.overwrite = overwrite;
  observed(callbacks, options,
           [&](const RunOptions& all) { run_experiment(*scene.experiment, *scene.scene, all); });
}

void resume(const fs::path& folder, const py::object& on_iteration, const py::object& on_level, bool progress,
            bool report, bool allow_memory) {
  Callbacks callbacks(on_iteration, on_level);
  const LargeMemory large = allow_memory ? LargeMemory::allowed : LargeMemory::refused;
  std::vector<std::string> warnings;
  ConfigErrors errors;
  const Registry& plugins = registry();
  std::optional<SavedRun> saved =
      without_gil([&] { return read_saved_run(folder, plugins, large, warnings, errors); });
  for (const std::string& warning : warnings) warn(warning);
  throw_errors(errors);
  if (!saved->interrupted) return;
  observed(callbacks, options_of(folder, progress, report), [&](const RunOptions& all) {
    resume_experiment(saved->experiment, *saved->scene, all, std::move(*saved->interrupted));
  });
}

/// A number of a level's stability test, or None.
template <class Of>
auto of_stability(const Of& of) {
  return [of](const MethodLevelResult& r) {
    return r.stability ? std::optional(of(*r.stability)) : std::nullopt;
  };
}

/// With the measures that runs have left.
RunCollection measured(const fs::path& folder) {
  std::vector<std::string> warnings;
  RunCollection runs = without_gil([&] {
    return measured_runs(
        {folder}, []() -> const Registry& { return registry(); }, warnings);
  });
  for (const std::string& warning : warnings) warn(warning);
  return runs;
}

void bind_results(py::module_& m) {
  m.def("_resume", &resume, py::arg("folder"), py::arg("on_iteration"), py::arg("on_level"),
        py::arg("progress"), py::arg("report"), py::arg("allow_memory"));
  m.def(
      "_table",
      [](const fs::path& folder) { return table_text(table_of(measured(folder)), {}, TableFormat::json); },
      py::arg("folder"), "The rows of `drape table FOLDER --format json`.");
  m.def(
      "_summary", [](const fs::path& folder) { return json_text(table_json(measured(folder))); },
      py::arg("folder"),
      "Columns, rows, units of varied keys, and the summary of rows over starts, as JSON.");
  m.def(
      "_run_page", [](const fs::path& folder) { return viewer_page(read_run(folder)); }, py::arg("folder"));
  m.def(
      "_draw",
      [](const fs::path& folder, const fs::path& file, const Text& method, std::optional<int> level,
         bool outline, std::optional<int> width, bool edges) {
        export_run(folder, file,
                   {.method = method,
                    .level = level,
                    .picture = {width, std::nullopt, outline, false, edges},
                    .overwrite = true});
      },
      py::arg("folder"), py::arg("file"), py::arg("method"), whole("level") = std::nullopt,
      py::arg("outline") = false, whole("width") = std::nullopt, py::arg("edges") = true,
      "As `drape export` of a .png.");
  m.def(
      "_read_mesh",
      [](const fs::path& folder, const Text& level) {
        TriangleMesh mesh = level_mesh(results_file(folder), parse_json(level)).mesh();
        return std::pair(std::move(mesh.vertices), std::move(mesh.triangles));
      },
      py::arg("folder"), py::arg("level"),
      "The mesh of a level that the folder's results.json describes so.");
  m.def("_uncomputed", &uncomputed, py::arg("text"));
  m.def("_refuse_target", &refuse_target, py::arg("file"), py::arg("overwrite"));
  m.def(
      "_write_file",
      [](const fs::path& file, const py::bytes& bytes, bool overwrite) {
        write_file(file, std::string_view(bytes), overwrite ? Existing::replaced : Existing::kept);
      },
      py::arg("file"), py::arg("bytes"), py::arg("overwrite"));
  m.def("_solver_style", &solver_style, py::arg("solver"),
        "Index of the colour and the mark that the solver has in every plot.");
}

}  // namespace

void bind_run(py::module_& m) {
  py::class_<Iteration>(m, "Iteration", "One Newton iteration and the state after it.")
      .def_readonly("method", &Iteration::method, "The method under way, as the experiment names it.")
      .def_readonly("level", &Iteration::level)
      .def_readonly("step", &Iteration::step)
      .def_readonly("iteration", &Iteration::iteration, "Within its step.")
      .def_readonly("time", &Iteration::time, "Pseudo-time; None without a schedule.")
      .def_readonly("seconds", &Iteration::seconds, "Since the method's start [s].")
      .def_readonly("flops", &Iteration::flops, "Of the level's factorisations.")
      .def_readonly("energy", &Iteration::energy, "Plain energy of the level [J].")
      .def_readonly("proxy_energy", &Iteration::proxy_energy,
                    "Energy that the method minimises in its place [J], or None.")
      .def_readonly("decrement", &Iteration::decrement,
                    "‖p‖ / (h √n) for the first h, or a bound of it [m/s].")
      .def_readonly("force_residual", &Iteration::force_residual, "[1]")
      .def_readonly("step_length", &Iteration::step_length, "α of the line search.")
      .def_readonly("step_size", &Iteration::step_size, "h [s].")
      .def_readonly("contacts", &Iteration::contacts, "Contacts closer than d̂; None without a contact model.")
      .def_readonly("smallest_gap", &Iteration::smallest_gap, "Of them [m].")
      .def_readonly("x", &Iteration::x, "n×3 positions [m], read-only.")
      .def("__repr__", [](const Iteration& i) {
        return "<drape.Iteration " + i.method + ", level " + std::to_string(i.level) + ", step " +
               std::to_string(i.step) + ", force_residual " + fixed_text(i.force_residual, 6) + ">";
      });

  py::class_<MethodLevelResult>(m, "LevelResult", "How a level of a method ended.")
      .def_readonly("method", &MethodLevelResult::method, "As the experiment names it.")
      .def_readonly("level", &MethodLevelResult::level)
      .def_property_readonly(
          "status", [](const MethodLevelResult& r) { return to_string(r.outcome); },
          "converged, max_steps_reached, stalled, cancelled, infeasible, …")
      .def_readonly("message", &MethodLevelResult::message)
      .def_readonly("steps", &MethodLevelResult::steps)
      .def_readonly("iterations", &MethodLevelResult::iterations)
      .def_readonly("factorisations", &MethodLevelResult::factorisations)
      .def_readonly("seconds", &MethodLevelResult::seconds)
      .def_readonly("seconds_by_phase", &MethodLevelResult::seconds_by_phase)
      .def_readonly("force_residual", &MethodLevelResult::force_residual, "Of the objective [1].")
      .def_property_readonly(
          "stability",
          [](const MethodLevelResult& r) {
            const std::string word = stability_word(r);
            return word.empty() ? std::nullopt : std::optional(word);
          },
          "stable, marginal, unstable or untested; None if the level did not end at an equilibrium.")
      .def_property_readonly("lowest_eigenvalue",
                             of_stability([](const auto& s) { return s.lowest_eigenvalue; }),
                             "Of M⁻¹H [1/s²].")
      .def_property_readonly("curvature_ratio", of_stability([](const auto& s) { return s.curvature_ratio; }),
                             "The least vᵀHv / vᵀH⁺v [1].")
      .def_readonly("saddles_left", &MethodLevelResult::saddles_left,
                    "Unstable equilibria from which the level went on.")
      .def_readonly("smallest_gap", &MethodLevelResult::smallest_gap, "[m]; None without a contact model.")
      .def_readonly("contact_stiffness", &MethodLevelResult::contact_stiffness,
                    "Barrier stiffness of each contact model at the end [Pa].")
      .def_readonly("x", &MethodLevelResult::x, "n×3 positions [m], read-only.");

  bind_results(m);
  py::class_<ExperimentHandle> experiment(py::object(m.attr("ExperimentBase")));
  experiment.def("_run", &run, py::arg("methods"), py::arg("out"), py::arg("on_iteration"),
                 py::arg("on_level"), py::arg("progress"), py::arg("report"), py::arg("overwrite"),
                 py::arg("allow_memory"));
}

}  // namespace drape::python
