#include "core/app/run/audit.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "core/kernel/files/message_text.h"

namespace drape {

namespace {

/// Pins further off than this fraction of the cloth's diagonal are not at their targets.
constexpr double max_pin_distance = 1e-6;
/// Forces may be out of balance by so many times what the method claims.
constexpr double residual_slack = 10;

double distance_of_pins(const LevelModel& model, const Positions& x) {
  double most = 0;
  for (const DirichletVertex& d : model.dirichlet())
    most = std::max(most, (x.row(d.vertex).transpose() - d.target).norm());
  return most;
}

/// LevelModel::force_residual of the vertices without contact forces.
double residual_without_contacts(const LevelModel& model, const Positions& x) {
  Positions g;
  model.energy_gradient(x, g);
  const double scale = model.residual_scale(x, g);
  const Eigen::VectorXd pressure = model.contact_pressure(x);
  for (int v = 0; v < g.rows(); ++v)
    if (model.fixed()[v] || (pressure.size() > 0 && pressure[v] > 0)) g.row(v).setZero();
  return g.norm() / scale;
}

}  // namespace

void require_level(const Scene& scene, int level) {
  if (level < 0 || level > scene.finest())
    throw std::runtime_error("the method reported level " + std::to_string(level) +
                             "; the experiment's finest is level " + std::to_string(scene.finest()));
}

void require_state(const Scene& scene, int level, const Positions& x) {
  require_level(scene, level);
  const auto refuse = [&](const std::string& fault) {
    throw std::runtime_error("the method reported a state of level " + std::to_string(level) + fault);
  };
  const int vertices = scene.hierarchy.levels[level].vertex_count();
  if (x.rows() != vertices)
    refuse(" with " + std::to_string(x.rows()) + " vertices; the level has " + std::to_string(vertices));
  if (!x.allFinite()) refuse(" that is not finite");
}

LevelResult audited(const Scene& scene, LevelResult result, double force_tolerance) {
  require_state(scene, result.level, result.x);
  if (!has_converged(result.outcome)) return result;
  const auto refuse = [&](Outcome outcome, const std::string& fault) {
    result.outcome = outcome;
    result.message = "the method says that it converged; " + fault;
  };
  const LevelModel& model = *scene.model(result.level);
  if (scene.load_stepping && !scene.load_stepping->finished()) {
    refuse(Outcome::infeasible, "the schedule has not come to its end");
  } else if (const double distance = distance_of_pins(model, result.x);
             !(distance <= max_pin_distance * bounding_box_diagonal(result.x))) {
    refuse(Outcome::infeasible, "a pin is " + three_digits(distance) + " m off its target");
  } else if (result.level == scene.finest() && result.outcome == Outcome::converged) {
    const double residual =
        residual_without_contacts(model.with_stiffness(result.contact_stiffness), result.x);
    if (!(residual <= residual_slack * std::max(result.force_residual, force_tolerance)))
      refuse(Outcome::stalled, "the force residual is " + three_digits(residual));
  }
  return result;
}

}  // namespace drape
