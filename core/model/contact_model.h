#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/hierarchy/level.h"
#include "core/model/energy.h"
#include "core/model/material.h"

namespace drape {

/// Two primitives and how they stand to each other, in words that a person can act on.
struct Touch {
  std::string first, second;                        ///< "cloth triangle 12", "ball: sphere"
  Eigen::Vector3d where = Eigen::Vector3d::Zero();  ///< [m]
};

/// "cloth triangle 12 and ball: sphere at (0.1, 0, 0.3)".
std::string to_string(const Touch& touch);

/// Numbers that a contact model knows a contact by, from one state to another.
using ContactKey = std::array<int, 5>;

/// How far a contact has slipped since it stuck.
struct Slip {
  ContactKey contact;
  Eigen::Vector3d by;  ///< of one side relative to the other, along the surface [m]
};

/// Ascending by contact, none twice.
using Slips = std::vector<Slip>;

/// The friction potential D of lagged contacts.
class FrictionEnergy : public BoundEnergy {
 public:
  /// Appends, in any order, what each contact has slipped at x, by its slip distance at most: what sticks or
  /// slides on is held by the same force in the next step.
  virtual void add_slips(const Positions& x, Slips& slips) const = 0;
  /// The same in full, where what the cloth's vertices touch of obstacles has moved by `carried` (n×3) [m].
  virtual void add_slips_carried(const Positions& x, const Positions& carried, Slips& slips) const = 0;
};

/// The contacts within range at one state: a value that is built, evaluated and looked at. As an energy it
/// is the barrier B over those contacts, and x is always the state that it was built for. Elements may
/// have fewer vertices of the cloth than the stencil has columns: -1 stands for none.
class ContactSet : public BoundEnergy {
 public:
  virtual int contact_count() const = 0;
  virtual double smallest_gap() const = 0;  ///< [m]; +∞ without a contact

  /// The lagged friction potential D with this set's normal forces and tangents, of displacements from
  /// `from` (n×3), added to what its contacts among `slips` had slipped there; null without friction. Its
  /// stencils have -1 as above.
  virtual std::unique_ptr<FrictionEnergy> friction(const Positions& from, const Slips& slips) const = 0;
};

/// Everything that may come within range on the straight way from x0 to x1.
class ContactSweep {
 public:
  virtual ~ContactSweep() = default;
  /// How far along the way nothing touches, a part of every gap kept.
  virtual StepLimit max_step() const = 0;
  /// The contacts at x, a state on the way, no farther than max_step.
  virtual std::unique_ptr<ContactSet> build(const Positions& x) const = 0;
};

/// A contact model bound to one level and its obstacles. Immutable.
class BoundContact {
 public:
  virtual ~BoundContact() = default;
  /// Looks for candidates between x0 and x1 (n×3, kept by copy), x0 being free of intersections.
  virtual std::unique_ptr<ContactSweep> sweep(const Positions& x0, const Positions& x1) const = 0;
  /// Pairs of primitives that intersect or touch at x, by exact predicates where the shapes are meshes.
  virtual std::vector<Touch> intersections(const Positions& x) const = 0;
  /// What is in the way, as meshes to be drawn.
  virtual std::vector<TriangleMesh> obstacles() const = 0;
};

/// An optional ability of a BoundContact whose obstacles may stand elsewhere than in the one before it.
class MovableObstacles {
 public:
  virtual ~MovableObstacles() = default;
  /// How far the obstacles come from where `before`, of the same kind and level, has them to where this has
  /// them, the cloth staying at x, touching nothing and keeping a part of every gap. The way is that of
  /// parameters that change linearly, so that it is 1 where they are changed by this part only, and where
  /// nothing has moved. Throws std::runtime_error naming an obstacle that is no longer made of the same
  /// parts.
  virtual StepLimit max_move(const BoundContact& before, const Positions& x) const = 0;
  /// Moves the rows of `from` (n×3) of vertices that touch obstacles, with friction, at x along with what
  /// they touch.
  virtual void carry(const BoundContact& before, const Positions& x, Positions& from) const = 0;
};

/// The contacts of one level, which may be shared by its models under different conditions.
using BoundContacts = std::vector<std::shared_ptr<const BoundContact>>;

/// A kind of contact, made by name from its parameters.
class ContactModel {
 public:
  virtual ~ContactModel() = default;
  /// Null when there is nothing to keep apart: then no contact code runs at all.
  virtual std::unique_ptr<BoundContact> bind(const Level& level, const Material& material) const = 0;
};

}  // namespace drape
