#pragma once

#include <memory>
#include <vector>

#include "core/model/contact_model.h"
#include "core/numerics/stopwatch.h"

namespace drape {

/// What the contacts of a level remember at the beginning of a step.
struct ContactMemory {
  Positions from;                    ///< n×3, where friction's displacements count from [m]
  std::vector<Slips> slips;          ///< of each model's contacts, there
  Positions sweep_begin, sweep_end;  ///< the way that the contacts of the step were found along [m]
  double seconds_building = 0;
};

/// The contacts of one level while something is minimised on it: what may come near, what is near, and what
/// friction remembers. Empty, and without any work, where the level has no contact model.
class ActiveContacts {
 public:
  explicit ActiveContacts(const BoundContacts& models) : models_(models) {}

  bool any() const { return !models_.empty(); }
  bool has_friction() const;
  /// For motions that are no sliding, as from a level to the next.
  void leave_out_friction() { with_friction_ = false; }

  /// A step begins at x: friction takes the normal forces and tangents there, and remembers how far each
  /// contact has slipped.
  void begin_step(const Positions& x);
  /// The models, `before` until now, with the cloth at `from`, are those of other conditions, and the cloth,
  /// within both, is at x: contacts have slipped by the cloth's way less the obstacles'.
  void models_changed(const BoundContacts& before, const Positions& from, const Positions& x);
  /// Whether that has happened since the last step.
  bool carried() const { return carried_; }
  /// Renews the normal forces and tangents at x; displacements count from where they did.
  void renew_lag(const Positions& x);

  /// What it takes to be again as just after begin_step.
  ContactMemory memory() const;
  /// Is again as just after begin_step(x), contacts in the same order.
  void restore(const ContactMemory& memory, const Positions& x);

  /// How far from x0 towards x1 nothing touches. States on the way may then be evaluated.
  StepLimit max_step(const Positions& x0, const Positions& x1);

  /// Barrier [J] at x, which is the start or on the way of the last max_step.
  double barrier(const Positions& x);
  double friction(const Positions& x) const;
  double add_gradient(const Positions& x, Positions& g);  ///< barrier and friction; adds both energies

  /// All energies at x that the matrix is made of.
  std::vector<const BoundEnergy*> energies(const Positions& x);

  double seconds_building() const { return seconds_building_; }  ///< in all, for contact sets

  int count() const;            ///< contacts at the state last evaluated
  double smallest_gap() const;  ///< there [m]; +∞ without a contact

 private:
  struct Way {
    Positions begin, end;
  };
  void sweep(const Positions& x0, const Positions& x1);
  void build(const Positions& x);
  void lag();
  /// Displacements count from x, where contacts keep what they have slipped; all of it, if obstacles have
  /// moved.
  void remember_slips(const Positions& x, const Positions* carried = nullptr);

  const BoundContacts& models_;
  std::vector<std::unique_ptr<ContactSweep>> sweeps_;
  std::vector<std::unique_ptr<ContactSet>> sets_;          // at state_
  std::shared_ptr<const Way> swept_, built_along_;         // of sweeps_, and of those that sets_ come from
  std::vector<std::unique_ptr<FrictionEnergy>> friction_;  // of each model, or null; empty before a step
  std::vector<Slips> slips_;                               // of each model
  Positions state_, from_;
  bool with_friction_ = true;
  bool carried_ = false;  // obstacles have moved since the last step
  double seconds_building_ = 0;
};

}  // namespace drape
