#include "core/app/python/prototype_solver.h"

#include <stdexcept>

#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/model/level_model.h"

namespace drape::python {

namespace {

Outcome outcome_of(const std::string& status) {
  for (const Outcome outcome : {Outcome::converged, Outcome::max_steps_reached, Outcome::stalled,
                                Outcome::cancelled, Outcome::infeasible})
    if (status == to_string(outcome)) return outcome;
  throw py::value_error(
      "status must be converged, max_steps_reached, stalled, cancelled or infeasible, not \"" + status +
      "\"");
}

/// A run measures and compares the states that it is given, and searches them for contacts.
void require_finite(const Positions& x) {
  if (!x.allFinite()) throw py::value_error("x must be finite; end the level with the last state that is");
}

}  // namespace

const Problem& SolverProblem::problem() const {
  if (!*alive_) throw std::runtime_error("the solve that this problem belongs to has ended");
  return *problem_;
}

int SolverProblem::checked(int level) const {
  if (level < 0 || level >= level_count())
    throw py::index_error("the problem has the levels 0 … " + std::to_string(level_count() - 1));
  return level;
}

ModelHandle SolverProblem::model(int level) const {
  return {problem().models[checked(level)], nullptr, alive_};
}

Positions SolverProblem::prolong(int level, const Positions& x) const {
  checked(level + 1);
  Positions y = problem().hierarchy.linear[checked(level)] * x;
  problem().model(level + 1)->set_dirichlet(y);
  return y;
}

int SolverProblem::vertex_count() const {
  if (!under_way_) throw std::runtime_error("begin a level before its iterations and its end");
  return problem().models[under_way_->level]->level().vertex_count();
}

void SolverProblem::begin(int level) {
  if (under_way_) throw std::runtime_error("end the level before beginning another");
  checked(level);
  if (!results_.empty() && level <= results_.back().level)
    throw py::value_error("level " + std::to_string(level) + " cannot begin after level " +
                          std::to_string(results_.back().level) +
                          ": begin levels from coarse to fine, each at most once");
  under_way_.emplace();
  under_way_->level = level;
  under_way_->from_initial_state = results_.empty();
  began_ = clock_.seconds();
  const py::gil_scoped_release released;
  observer_->level_started(level);
}

bool SolverProblem::iteration(const Positions& x, std::optional<double> energy,
                              std::optional<double> force_residual, double step_length) {
  require_finite(x);
  const LevelModel& model = *problem().models[under_way_->level];
  const py::gil_scoped_release released;
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
}

void SolverProblem::end(const Positions& x, const std::string& status, const std::string& message) {
  require_finite(x);
  under_way_->outcome = outcome_of(status);
  under_way_->message = message;
  under_way_->x = x;
  under_way_->seconds = clock_.seconds() - began_;
  results_.push_back(std::move(*under_way_));
  under_way_.reset();
  const py::gil_scoped_release released;
  observer_->level_finished(results_.back());
}

void SolverProblem::expire() { *alive_ = false; }

std::vector<LevelResult> SolverProblem::finish() {
  expire();
  if (under_way_)
    throw py::value_error("solve has not ended level " + std::to_string(under_way_->level) +
                          ": call problem.end with its last state before returning");
  if (results_.empty())
    throw py::value_error(
        "solve has ended no level: call problem.begin and problem.end for each level that it solves");
  return std::move(results_);
}

std::vector<LevelResult> PythonSolver::solve(const Problem& problem, Observer& observer) const {
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

}  // namespace drape::python
