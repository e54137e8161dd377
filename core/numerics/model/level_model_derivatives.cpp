// Derivatives of the whole energy E_l, with limits and contacts.

#include "core/numerics/model/hessian_assembler.h"
#include "core/numerics/model/level_model.h"

namespace drape {

double LevelModel::energy_gradient(const Positions& x, Positions& g) const {
  double sum = gradient(x, g);
  for (const BoundEnergy* limit : limits_) sum += limit->add_gradient(x, g);
  double barriers = 0;
  for (const auto& contact : contacts_)
    barriers += contact->build_candidates(x, x)->build_collisions(x)->add_gradient(x, g);
  return sum + barriers;
}

BlockMatrix LevelModel::energy_hessian(const Positions& x, Projection projection) const {
  std::vector<std::unique_ptr<Collisions>> collisions;
  std::vector<const BoundEnergy*> energies;
  for (const Term& term : terms_)
    if (!term.is_linear()) energies.push_back(term.energy.get());
  for (const auto& contact : contacts_) {
    collisions.push_back(contact->build_candidates(x, x)->build_collisions(x));
    energies.push_back(collisions.back().get());
  }
  return hessian_of(energies, x, projection);
}

}  // namespace drape
