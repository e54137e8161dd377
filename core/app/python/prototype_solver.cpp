#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/app/python/module.h"
#include "core/app/python/values.h"
#include "core/kernel/plugin/bounds.h"
#include "core/kernel/threads/stopwatch.h"
#include "core/numerics/mesh/same_entries.h"
#include "core/numerics/model/active_contacts.h"

namespace drape::python {

namespace {

Outcome outcome_of(const std::string& status) {
  for (const Outcome outcome : {Outcome::converged, Outcome::saddle, Outcome::max_steps_reached,
                                Outcome::stalled, Outcome::cancelled, Outcome::infeasible})
    if (status == to_string(outcome)) return outcome;
  throw py::value_error(
      "status must be converged, saddle, max_steps_reached, stalled, cancelled or infeasible, not \"" +
      status + "\"");
}

/// What a solver in Python works on, and how it reports. Usable until its solve ends; then every call raises
/// RuntimeError. Used with the GIL held, which its reports release.
class SolverProblem {
 public:
  SolverProblem(const Problem& problem, Observer& observer) : problem_(&problem), observer_(&observer) {}

  int level_count() const { return static_cast<int>(problem().models.size()); }
  ModelHandle model(int level) const { return {problem().models[checked(level)], nullptr, alive_}; }
  Positions start(int level) const { return problem().starts.at(checked(level)); }

  Positions prolong(int level, const State& x) const {
    checked(level + 1);
    const Problem& p = problem();
    Positions y = p.hierarchy.prolong(x.of(p.models[checked(level)]->level().vertex_count()), level,
                                      level + 1, p.hierarchy.linear);
    p.model(level + 1)->set_dirichlet(y);
    return y;
  }

  void begin(int level) {
    if (under_way_) throw std::runtime_error("end the level before beginning another");
    checked(level);
    if (!results_.empty() && level <= results_.back().level)
      throw py::value_error("level " + std::to_string(level) + " cannot begin after level " +
                            std::to_string(results_.back().level) +
                            ": begin levels from coarse to fine, each at most once");
    under_way_.emplace();
    under_way_->level = level;
    under_way_->from_initial_state = results_.empty();
    iterated_.resize(0, 3);
    began_ = clock_.seconds();
    without_gil([&] { observer_->level_started(level); });
  }

  bool iteration(const State& state, std::optional<double> energy, std::optional<double> force_residual,
                 double step_length) {
    const Positions& x = reported(state);
    const LevelModel& model = *problem().models[under_way_->level];
    iterated_ = x;
    return without_gil([&] {
      IterationRow row;
      row.level = under_way_->level;
      row.step = under_way_->steps = ++under_way_->iterations;
      row.iteration = 1;
      row.seconds = clock_.seconds();
      row.energy = energy ? *energy : model.energy(x);
      row.force_residual = under_way_->force_residual =
          force_residual ? *force_residual : model.force_residual(x);
      row.step_length = step_length;
      observer_->iteration(row, x);
      return !observer_->stop_requested();
    });
  }

  void end(const State& state, const std::string& status, const std::string& message) {
    const Positions& x = reported(state);
    under_way_->outcome = outcome_of(status);
    under_way_->message = message;
    under_way_->x = x;
    under_way_->seconds = clock_.seconds() - began_;
    const LevelModel& model = *problem().models[under_way_->level];
    without_gil([&] {
      if (!same_entries(x, iterated_)) under_way_->force_residual = model.force_residual(x);
      ActiveContacts contacts(model.contacts());
      if (!contacts.any()) return;
      contacts.barrier(x);  // evaluates the contacts for smallest_gap()
      under_way_->smallest_gap = contacts.smallest_gap();
    });
    results_.push_back(std::move(*under_way_));
    under_way_.reset();
    without_gil([&] { observer_->level_finished(results_.back()); });
  }

  /// Ends the solve, whatever it has reported.
  void expire() { *alive_ = false; }
  /// Ends the solve and returns the results of the levels that ended. Raises ValueError if none has, or one
  /// has begun and not ended.
  std::vector<LevelResult> finish() {
    expire();
    if (under_way_)
      throw py::value_error("solve has not ended level " + std::to_string(under_way_->level) +
                            ": call problem.end with its last state before returning");
    if (results_.empty())
      throw py::value_error(
          "solve has ended no level: call problem.begin and problem.end for each level that it solves");
    return std::move(results_);
  }

 private:
  const Problem& problem() const {
    if (!*alive_) throw std::runtime_error("the solve that this problem belongs to has ended");
    return *problem_;
  }
  int checked(int level) const {
    if (level < 0 || level >= level_count())
      throw py::index_error("the problem has the levels 0 … " + std::to_string(level_count() - 1));
    return level;
  }
  /// A state of the level that has begun: within bounds, because a run measures and compares the states that
  /// it is given, and searches them for contacts.
  const Positions& reported(const State& state) const {
    if (!under_way_) throw std::runtime_error("begin a level before its iterations and its end");
    const Positions& x = state.of(problem().models[under_way_->level]->level().vertex_count());
    if (!(x.array().abs() <= bounds::largest_coordinate).all())
      throw py::value_error("x must be finite and within 1e9 m; end the level with the last state that is");
    return x;
  }

  const Problem* problem_;
  Observer* observer_;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
  const Stopwatch clock_;
  std::optional<LevelResult> under_way_;
  Positions iterated_;  // the level's last iteration; without rows before the first
  double began_ = 0;
  std::vector<LevelResult> results_;
};

/// A solver that a Python object runs: see drape.Solver. Without schedules and checkpoints.
class PythonSolver final : public Solver {
 public:
  explicit PythonSolver(const py::object& prototype) : prototype_(share(prototype)) {}

  std::vector<LevelResult> solve(const Problem& problem, Observer& observer) const override {
    if (problem.load_stepping)
      throw std::runtime_error("a solver in Python cannot follow a schedule; take the schedule out");
    return with_python([&] {
      const auto given = std::make_shared<SolverProblem>(problem, observer);
      try {
        prototype_->attr("solve")(given);
      } catch (...) {
        given->expire();
        throw;
      }
      return given->finish();
    });
  }

 private:
  SharedObject prototype_;
};

}  // namespace

std::shared_ptr<Solver> prototype_solver(const py::object& prototype) {
  return std::make_shared<PythonSolver>(prototype);
}

void bind_prototype_problem(py::module_& m) {
  py::class_<SolverProblem, std::shared_ptr<SolverProblem>>(
      m, "Problem", "What a solver in Python works on. Valid during its `solve`.")
      .def_property_readonly("level_count", &SolverProblem::level_count)
      .def("model", &SolverProblem::model, whole("level"), "The plain Model of a level.")
      .def("start", &SolverProblem::start, whole("level"), "The initial state of a level, n×3 [m].")
      .def("prolong", &SolverProblem::prolong, whole("level"), py::arg("x"),
           "A level's state on the next finer one, by linear interpolation over the rest shape, Dirichlet "
           "vertices at their targets.")
      .def("begin", &SolverProblem::begin, whole("level"), "Begin a level, finer than the last.")
      .def("iteration", &SolverProblem::iteration, py::arg("x"), py::arg("energy") = py::none(),
           py::arg("force_residual") = py::none(), py::arg("step_length") = 1.0,
           "Report an iteration's state. Returns False after a request to stop: end the level as cancelled. "
           "Energy and residual are those of the plain model at x if they are not given.")
      .def("end", &SolverProblem::end, py::arg("x"), py::arg("status") = "converged", py::arg("message") = "",
           "End the level: converged, saddle, max_steps_reached, stalled, cancelled or infeasible. Its force "
           "residual is that of the last iteration; of another x, that of the plain model.");
}

}  // namespace drape::python
