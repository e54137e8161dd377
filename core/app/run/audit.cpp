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
  const int vertices = scene.hierarchy.levels[level].vertex_count();
  const std::string reported = "the method reported a state of level " + std::to_string(level);
  if (x.rows() != vertices)
    throw std::runtime_error(reported + " with " + std::to_string(x.rows()) + " vertices; the level has " +
                             std::to_string(vertices));
  if (!x.allFinite()) throw std::runtime_error(reported + " that is not finite");
}

LevelResult audited(const Scene& scene, LevelResult result, double force_tolerance) {
  require_state(scene, result.level, result.x);
  if (!has_converged(result.outcome)) return result;
  const LevelModel model = scene.model(result.level)->with_stiffness(result.contact_stiffness);
  if (const double distance = distance_of_pins(model, result.x);
      !(distance <= max_pin_distance * bounding_box_diagonal(result.x)))
    result.outcome = Outcome::infeasible, result.message = "the method says that it converged; a pin is " +
                                                           three_digits(distance) + " m off its target";
  if (result.level < scene.finest()) return result;
  const double residual = residual_without_contacts(model, result.x),
               claimed = std::max(result.force_residual, force_tolerance);
  if (!(residual <= residual_slack * claimed) && result.outcome == Outcome::converged)
    result.outcome = Outcome::stalled,
    result.message = "the method says that it converged; the force residual is " + three_digits(residual);
  return result;
}

}  // namespace drape
