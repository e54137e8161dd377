#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/kernel/interfaces/solver.h"
#include "core/numerics/model/objective.h"

namespace drape {

/// The point x of a minimisation: the fixed vertices, and the objective's energy and forces at x.
///
/// x, the force residual, the counts and the seconds of each phase are in a LevelResult, to which the parts
/// of the solver add.
class Iterate {
 public:
  /// What does not follow from x.
  struct State {
    double residual_scale = 1;  ///< [N]
    std::string limited_by;     ///< name of what limited the last motion of the cloth; empty if nothing did
  };
  State state() const { return s_; }
  void restore(const State& state) { s_ = state; }

  /// Refers to both arguments. Energy and forces are undefined before the first evaluate().
  Iterate(Objective& objective, LevelResult& result);

  Objective& objective() const { return f_; }
  const LevelModel& model() const { return f_.model(); }
  LevelResult& result() const { return result_; }
  double rest_diagonal() const { return rest_diagonal_; }  ///< of the rest shape's bounding box [m]

  const Positions& x() const { return result_.x; }             ///< n×3 [m]
  double energy() const { return energy_; }                    ///< F(x) [J]
  const Positions& gradient() const { return gradient_; }      ///< ∇F(x), n×3 [N]
  double residual_scale() const { return s_.residual_scale; }  ///< [N]
  double force_residual() const { return result_.force_residual; }

  const std::vector<char>& fixed() const { return fixed_; }  ///< one flag a vertex
  double free_count() const { return free_count_; }          ///< number of vertices that are not fixed
  Eigen::RowVector3d free_centroid() const;                  ///< of these vertices [m]

  /// Sets the fixed vertices and an additional energy, or null; evaluates again if x was evaluated before.
  void set_constraints(const std::vector<char>& fixed, const BoundEnergy* penalty);

  /// Evaluates energy and forces at x.
  void evaluate();
  /// Computes the force residual from the forces.
  void update_residual();
  /// Updates friction's lagged normal forces and tangents to x: equilibrium is a fixed point of the lagging.
  void update_friction();

  /// Sets x alone: energy and forces stay those of the old x until evaluate().
  void move_to(const Positions& x) { result_.x = x; }
  /// Exchanges x and its forces with those of another point with this energy [J].
  void swap(Positions& x, Positions& gradient, double energy);
  /// Replaces the model by that of the same level under another load. The cloth was at `from` when the load
  /// changed.
  void set_model(std::shared_ptr<const LevelModel> model, const Positions& from);

  /// The objective's matrix at x [N/m]; overwrites the one before.
  const BlockMatrix& hessian(Projection projection) const;
  /// Whether the smallest gap at x is below this fraction of rest_diagonal().
  bool has_gap_below(double fraction) const;
  /// The largest feasible step from x towards x1.
  StepLimit max_step(const Positions& x1) const;

  const std::string& limited_by() const { return s_.limited_by; }
  void set_limited_by(const std::string& name) { s_.limited_by = name; }
  /// limited_by() as the end of a message; empty if nothing limited the motion.
  std::string limit_text() const {
    return s_.limited_by.empty() ? "" : "; the step is limited by " + s_.limited_by;
  }

  /// Differences of energies below this [J] are round-off, with `inertia` added to F(x) [J]. The scale
  /// includes the load's work across the cloth, because terms of the energy cancel while their round-off does
  /// not.
  double energy_noise(double inertia) const;
  /// F(x) without friction, whose potential depends on more than the state [J].
  double energy_without_friction() const { return energy_ - f_.contacts().friction(result_.x); }

 private:
  Objective& f_;
  LevelResult& result_;
  double rest_diagonal_;
  State s_;
  std::vector<char> fixed_;
  double free_count_ = 0;
  Positions gradient_;
  double energy_ = 0;
};

}  // namespace drape
