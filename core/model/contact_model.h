#pragma once

#include <memory>

#include "core/hierarchy/level.h"
#include "core/model/energy.h"
#include "core/model/material.h"

namespace drape {

/// The contacts active at one state: a value that is built, evaluated and looked at.
/// As an energy it is the barrier B (and friction D) over those contacts.
class ContactSet : public BoundEnergy {
 public:
  virtual int contact_count() const = 0;
  virtual double smallest_gap() const = 0;  ///< [m]; +∞ without a contact
};

/// A contact model bound to one level and its obstacles. Immutable.
class BoundContact {
 public:
  virtual ~BoundContact() = default;
  /// The contacts within range of state x (n×3).
  virtual std::unique_ptr<ContactSet> build(const Positions& x) const = 0;
  /// Largest fraction in [0, 1] of the straight way from x0 to x1 that is free of intersections.
  virtual double max_step(const Positions& x0, const Positions& x1) const = 0;
  /// Number of intersecting pairs of primitives at x.
  virtual int intersections(const Positions& x) const = 0;
};

/// A kind of contact, made by name from its parameters.
class ContactModel {
 public:
  virtual ~ContactModel() = default;
  /// Null when there is nothing to keep apart: then no contact code runs at all.
  virtual std::unique_ptr<BoundContact> bind(const Level& level, const Material& material) const = 0;
};

}  // namespace drape
