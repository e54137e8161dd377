#include "core/app/run/audit.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/kernel/files/message_text.h"
#include "core/numerics/contact_forces/friction.h"
#include "core/numerics/contact_forces/friction_balance.h"
#include "core/numerics/model/required.h"
#include "core/numerics/step/rounding_floor.h"

namespace drape {

namespace {

/// Pins further off than this fraction of the cloth's diagonal are not at their targets.
constexpr double max_pin_distance = 1e-6;
/// How far forces may be out of balance, over what a state at rest may have.
constexpr double residual_slack = 10;

double distance_of_pins(const LevelModel& model, const Positions& x) {
  double most = 0;
  for (const DirichletVertex& d : model.dirichlet())
    most = std::max(most, (x.row(d.vertex).transpose() - d.target).norm());
  return most;
}

/// LevelModel::force_residual, less what friction can carry; on the same side of `enough`.
double residual_beyond_friction(const LevelModel& model, const Positions& x, double enough) {
  Positions g;
  model.energy_gradient(x, g);
  const double scale = model.residual_scale(x, g);
  std::vector<FrictionContact> frictions;
  for (const auto& contact : model.contacts())
    for (const auto& group : friction_contacts(*collisions_at(*contact, x)))
      frictions.insert(frictions.end(), group.begin(), group.end());
  return norm_beyond_friction(frictions, std::move(g), model.fixed(), enough * scale) / scale;
}

/// Bound on the force residual by round-off [1].
double rounding_residual(const LevelModel& model, const Positions& x) {
  Positions g;
  model.energy_gradient(x, g);
  const BlockMatrix hessian = model.energy_hessian(x, Projection::none);
  return rounding_floor(hessian, x, g, model.fixed()).norm / model.residual_scale(x, g);
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
  } else if (result.level == scene.finest()) {
    const LevelModel pressed = model.with_stiffness(result.contact_stiffness);
    const double rounding = result.outcome == Outcome::converged ? 0 : rounding_residual(pressed, result.x),
                 enough = residual_slack * std::max(rounding, force_tolerance),
                 residual = residual_beyond_friction(pressed, result.x, enough);
    if (!(residual <= enough)) refuse(Outcome::stalled, "the force residual is " + three_digits(residual));
  }
  return result;
}

}  // namespace drape
