#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "core/kernel/interfaces/contact_model.h"
#include "core/kernel/interfaces/energy.h"

// What plugins return, as the code that goes on with it needs it.

namespace drape {

/// What a plugin's function `by` made. Throws std::runtime_error for null; an object may have no `elements`.
template <class T>
std::unique_ptr<T> required(std::unique_ptr<T> made, const std::string& by, const std::string& elements) {
  if (!made) throw std::runtime_error(by + " returned null; return an object, which may have no " + elements);
  return made;
}

/// The energy on the level. Throws as required does.
inline std::unique_ptr<BoundEnergy> bound_energy(const Energy& energy, const Level& level,
                                                 const Material& material) {
  return required(energy.bind(level, material), "bind", "elements");
}

inline std::unique_ptr<CollisionCandidates> candidates_of(const BoundContact& contact, const Positions& x0,
                                                          const Positions& x1) {
  return required(contact.build_candidates(x0, x1), "a contact model's build_candidates", "contacts");
}
inline std::unique_ptr<Collisions> collisions_of(const CollisionCandidates& candidates, const Positions& x) {
  return required(candidates.build_collisions(x), "a contact model's build_collisions", "contacts");
}
/// The collisions at x, of candidates that are there alone.
inline std::unique_ptr<Collisions> collisions_at(const BoundContact& contact, const Positions& x) {
  return collisions_of(*candidates_of(contact, x, x), x);
}

/// As energy.add_gradient(x, g). Throws std::runtime_error, which names the energy, if that has replaced g by
/// a matrix of another size: the next energy would write beyond its end.
inline double add_gradient_of(const BoundEnergy& energy, const std::string& name, const Positions& x,
                              Positions& g) {
  const double value = energy.add_gradient(x, g);
  if (g.rows() != x.rows())
    throw std::runtime_error("energy " + name + ": add_gradient has changed the size of g to " +
                             std::to_string(g.rows()) + " rows, not " + std::to_string(x.rows()) +
                             "; add to its rows");
  return value;
}

}  // namespace drape
