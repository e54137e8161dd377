#include <optional>
#include <set>

#include "core/app/python/module.h"
#include "core/app/python/values.h"
#include "core/app/run/saved_run.h"
#include "core/app/setup/build_scene.h"
#include "core/numerics/solve/stepped_solve.h"

namespace drape::python {

namespace {

/// A state to resume from, and what it is a state of.
struct Checkpoint {
  MethodState state;
  std::string method;
  std::string experiment;  ///< resolved, as text
  int level = -1;          ///< of the last change of it; -1 without one
  Positions start;         ///< from which the solve then went on
};

/// A method that Python advances, one iteration at a time. While one thread of Python waits for the solver,
/// calls of others raise RuntimeError.
class Solve {
  /// Runs the body without the GIL, while others are refused.
  template <class Body>
  auto exclusively(const Body& body) {
    idle();
    struct Busy {
      bool& flag;
      explicit Busy(bool& f) : flag(f) { flag = true; }
      ~Busy() { flag = false; }
    };
    const Busy busy(busy_);
    return without_gil(body);
  }

 public:
  /// All solves that exist, guarded by the GIL. Never destroyed: solves may outlive the module.
  static std::set<Solve*>& all() {
    static auto* const all = new std::set<Solve*>;
    return *all;
  }

  Solve(const ExperimentHandle& handle, const std::string& method, const std::optional<Checkpoint>& start)
      : scene_(handle.scene(true)) {
    using Names = std::vector<std::string>;
    const Names chosen = chosen_methods(*scene_.experiment, method.empty() ? Names{} : Names{method});
    if (chosen.size() != 1) throw std::runtime_error("name one method to iterate, not all");
    method_ = chosen.front();
    if (start && start->method != method_)
      throw std::runtime_error("the checkpoint is one of the method " + start->method + ", not of " +
                               method_);
    if (start && start->experiment != scene_.experiment->resolved.one_line())
      throw std::runtime_error(
          "the checkpoint is one of an experiment with other values; set them back, or use "
          "Solve.set to change them during a solve");
    if (start && start->level >= 0) {
      ConfigErrors errors;
      without_gil([&] { scene_ = warm_started(scene_.experiment, start->level, start->start, errors); });
      throw_errors(errors);
      level_ = start->level;
    }
    solve_ = begin(scene_, start ? start->state : MethodState());
    all().insert(this);
  }
  ~Solve() {
    all().erase(this);
    end();
  }
  Solve(const Solve&) = delete;
  Solve& operator=(const Solve&) = delete;

  /// Raises RuntimeError while the solve is being advanced, and once it has been ended.
  SteppedSolve& idle() {
    if (busy_)
      throw std::runtime_error("the solve is being advanced, by another thread or by its own solver");
    if (!solve_) throw std::runtime_error("the solve has ended, with the interpreter");
    return *solve_;
  }
  const std::string& method() const { return method_; }
  const SceneHandle& scene() {
    idle();
    return scene_;
  }

  Iteration next() {
    const bool advanced = exclusively([&] { return solve_->advance(); });
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!advanced) throw py::stop_iteration();
    return {solve_->row(), solve_->x(), method_};
  }

  std::vector<MethodLevelResult> levels() {
    std::vector<MethodLevelResult> levels;
    for (const LevelResult& result : idle().finished()) levels.push_back({result, method_});
    return levels;
  }

  Checkpoint checkpoint() {
    return {idle().checkpoint(), method_, scene_.experiment->resolved.one_line(), level_,
            level_ < 0 ? Positions() : scene_.scene->starts[level_]};
  }

  /// Goes on from the present state on its level: Dirichlet vertices move from there to their targets.
  /// Several changes in a row go on from the same state.
  void set(const Text& key, const py::object& value) {
    const bool iterated = idle().x().rows() > 0;
    if (!iterated && level_ < 0)
      throw std::runtime_error("nothing is iterated yet; set " + key + " in the experiment");
    const auto changed = ExperimentHandle{with_value(scene_.experiment->source, key, value)}.read();
    ConfigErrors errors;
    exclusively([&] {
      const int level = iterated ? solve_->row().level : level_;
      const Positions& x = iterated ? solve_->x() : scene_.scene->starts[level];
      refuse_other_cloth(*scene_.experiment, *changed, level, errors);
      if (!errors.empty()) return;
      const SceneHandle next = warm_started(changed, level, x, errors);
      if (!errors.empty()) return;
      MethodState from;
      from.level = level;
      solve_ = begin(next, std::move(from));
      level_ = level;
      scene_ = next;
    });
    throw_errors(errors);
  }

  /// Ends the solve; every later call raises RuntimeError.
  void end() {
    if (busy_) return;  // whoever advances it keeps it
    std::unique_ptr<SteppedSolve> ended = std::move(solve_);
    const WithoutGil released;  // its thread may need the GIL to end
    ended.reset();
  }

 private:
  /// The experiment's scene, which begins at x on that level.
  static SceneHandle warm_started(const std::shared_ptr<const Experiment>& experiment, int level,
                                  const Positions& x, ConfigErrors& errors) {
    std::shared_ptr<Scene> scene =
        build_scene(*experiment, errors, LargeMemory::allowed, IntersectingStart::allowed);
    if (scene) warm_start_scene(*experiment, *scene, level, x, errors);
    return {experiment, scene};
  }

  std::unique_ptr<SteppedSolve> begin(const SceneHandle& s, MethodState from) const {
    return std::make_unique<SteppedSolve>(s.experiment->solver_of(method_), *s.scene, std::move(from));
  }

  SceneHandle scene_;
  std::string method_;
  int level_ = -1;                       // of the last change; -1 before the first
  bool busy_ = false;                    // guarded by the GIL
  std::unique_ptr<SteppedSolve> solve_;  // last: it refers to the scene
};

/// For the interpreter's exit: a prototype's solver cannot take the GIL any more after it.
void end_all_solves() {
  WithoutGil::wait_for_all();
  const std::set<Solve*> all = Solve::all();
  for (Solve* solve : all)
    if (Solve::all().count(solve) > 0) solve->end();  // one's end may destroy another
}

}  // namespace

void bind_solve(py::module_& m) {
  py::module_::import("atexit").attr("register")(py::cpp_function(&end_all_solves));
  py::class_<Checkpoint>(
      m, "Checkpoint",
      "The state of a solve at the beginning of a step. Experiment.solver(method, start=checkpoint) goes on "
      "from it with the bits of a solve that was not interrupted, and repeats the step.")
      .def_property_readonly("level", [](const Checkpoint& c) { return c.state.level; });

  py::class_<Solve>(
      m, "Solve",
      "One method of an experiment, advanced an iteration at a time: `for iteration in solver`. Nothing is "
      "recorded.")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &Solve::next)
      .def(
          "stop", [](Solve& s) { s.idle().stop(); }, "End the solve at its next step.")
      .def(
          "refine", [](Solve& s) { s.idle().refine(); },
          "End the level at its next step and begin the next finer one.")
      .def("set", &Solve::set, py::arg("key"), py::arg("value"),
           "Change one value of the experiment, a material's or a pin's, and go on from the present state. "
           "Raises ConfigError, with nothing changed, if it is refused.")
      .def("checkpoint", &Solve::checkpoint, "The state at the beginning of the step of the last iteration.")
      .def_property_readonly("levels", &Solve::levels, "Results of the finished levels since the last `set`.")
      .def_property_readonly("method", &Solve::method)
      .def_property_readonly("scene", &Solve::scene, py::return_value_policy::copy);

  py::class_<ExperimentHandle> experiment(py::object(m.attr("ExperimentBase")));
  experiment.def(
      "solver",
      [](const ExperimentHandle& e, const Text& method, const std::optional<Checkpoint>& start) {
        return std::make_unique<Solve>(e, method, start);
      },
      py::arg("method") = "", py::arg("start") = py::none(),
      "A Solve of one method, to be advanced step by step; by default pcs, or the only method. `start` is a "
      "Checkpoint of the same experiment and method. Raises ConfigError, and RuntimeError for another "
      "experiment's checkpoint.");
}

}  // namespace drape::python
