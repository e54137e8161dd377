#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/contact_model.h"
#include "core/kernel/threads/stopwatch.h"
#include "core/numerics/contact_forces/contact_stiffness.h"
#include "core/numerics/contact_forces/friction.h"

namespace drape {

/// Under-relaxation of friction's lag.
struct LagDamping {
  double fraction = 1;  ///< of the change that a step's lag takes on; 1: the lag is that of the step's start
  /// The last step's lag of each contact model; empty without damping.
  std::vector<FrictionContacts> lag;
};

/// The state of a level's contacts at the beginning of a step, for checkpoints.
struct ContactMemory {
  Positions reference;  ///< n×3, from where tangential displacements are measured [m]
  /// How far the contacts of each model have slid, at `reference`.
  std::vector<TangentialDisplacements> tangential_displacements;
  Positions candidates_begin, candidates_end;  ///< the motion whose candidates gave the step's collisions [m]
  double seconds_building = 0;                 ///< total time of building collisions [s]
  ContactStiffness stiffness;                  ///< of each model
  LagDamping damping;
};

/// Candidates, collisions and lagged friction of one level during a minimisation. Does nothing on a level
/// without contact models.
class ActiveContacts {
 public:
  explicit ActiveContacts(BoundContacts models) : models_(std::move(models)) {}

  bool any() const { return !models_.empty(); }
  bool has_friction() const;
  /// For motions without physical sliding, as from one level to the next.
  void disable_friction() { friction_enabled_ = false; }

  /// The barrier stiffness of each model [Pa].
  ContactStiffness stiffness() const { return stiffness_of(models_); }
  /// Gives the models at least this barrier stiffness [Pa], empty or of each model.
  void set_stiffness(const ContactStiffness& stiffness);
  /// Keeps the barrier stiffness as it is from now on.
  void fix_stiffness() { stiffness_is_fixed_ = true; }
  /// Raises the barrier stiffness of each model whose contacts at x carry far more than its barrier is made
  /// for, to at most `largest` [Pa] (raised_stiffness). Returns whether any
  /// was raised. Call it between steps.
  bool raise_stiffness(const Positions& x, double largest);

  /// Starts a step at x: lags friction's normal forces and tangents there, and stores the tangential
  /// displacements.
  void begin_step(const Positions& x);
  /// Forgets the state: candidates, collisions and friction's history. Call it before begin_step at a state
  /// that no step has led to.
  void reset();
  /// Replaces the models, with the cloth at `from`, by those of the same level under another load, with the
  /// cloth at x. Updates tangential displacements by the relative motion of cloth and obstacles.
  void update_obstacles(const BoundContacts& models, const Positions& from, const Positions& x);
  /// Whether obstacle motion has advected tangential displacements since the last step began.
  bool advected() const { return advected_; }
  /// Lags normal forces and tangents at x. The reference of tangential displacements stays.
  void update_lagging(const Positions& x);

  /// Halves the fraction by which a step's lag follows the state, since the lag does not converge:
  /// equilibrium is a fixed point of it at any fraction. Until the damping ends, contacts that stick keep
  /// their force (Sticking). Returns false without friction, or if it is as small as it gets.
  bool damp_lag();
  /// Ends the damping, for another load.
  void end_lag_damping() { damping_ = {}; }

  /// What restore needs to reproduce the state after begin_step.
  ContactMemory memory() const;
  /// Reproduces the state after begin_step(x), with contacts in the same order.
  void restore(const ContactMemory& memory, const Positions& x);

  /// The largest collision-free step from x0 towards x1. States on that segment may then be evaluated.
  StepLimit max_step(const Positions& x0, const Positions& x1);

  /// Barrier [J] at x, which is x0 or on the segment of the last max_step.
  double barrier(const Positions& x);
  double friction(const Positions& x) const;              ///< [J]
  double add_gradient(const Positions& x, Positions& g);  ///< of barrier and friction; returns their sum [J]

  /// All energies at x that contribute to the Hessian.
  std::vector<const BoundEnergy*> energies(const Positions& x);

  double seconds_building() const { return seconds_building_; }  ///< total time of building collisions [s]

  int count() const;            ///< contacts at the state last evaluated
  double smallest_gap() const;  ///< there [m]; +∞ without a contact

 private:
  using PositionPair = std::pair<Positions, Positions>;
  void build_candidates(const Positions& x0, const Positions& x1);
  void build_collisions(const Positions& x);
  /// Sets friction_ from the collisions. A step's lag is the damped one.
  void lag_friction(bool of_step);
  /// Adds the next model's friction_, from its lag.
  void set_next_friction(FrictionContacts lag);
  /// Stores the tangential displacements at x and makes x their reference. With the models `before` obstacles
  /// moved, they are advected and not limited. Returns whether an obstacle that the cloth touches has moved.
  bool store_tangential_displacements(const Positions& x, const BoundContacts* before = nullptr);
  /// `moved` becomes true with the first point that has.
  ObstacleMotion motion_since(const BoundContacts& before, std::size_t model, bool& moved) const;

  /// Takes models of another barrier stiffness, with the candidates found again.
  void replace(BoundContacts models);

  BoundContacts models_;
  std::vector<std::unique_ptr<CollisionCandidates>> candidates_;
  std::vector<std::unique_ptr<Collisions>> collisions_;                        // at state_
  std::shared_ptr<const PositionPair> candidates_motion_, collisions_motion_;  // that each was built for
  // One for each model, null without friction; empty before a step.
  std::vector<std::unique_ptr<const LaggedFriction>> friction_;
  std::vector<TangentialDisplacements> tangential_displacements_;  // of each model
  Positions state_;                                                // that the collisions were built at
  Positions reference_;  // that tangential displacements are measured from
  LagDamping damping_;
  bool friction_enabled_ = true, stiffness_is_fixed_ = false;
  bool advected_ = false;
  double seconds_building_ = 0;
};

}  // namespace drape
