// Values and derivatives of the smooth energies, and of the whole energy E_l, with limits and contacts.

#include <cmath>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/mesh/area_vectors.h"
#include "core/numerics/model/hessian_assembler.h"
#include "core/numerics/model/level_model.h"
#include "core/numerics/model/required.h"

namespace drape {

double LevelModel::linear_value(const Positions& x, Positions* g, Roles roles) const {
  constexpr int rows_at_once = 8192;  // per task
  double value = 0;
  bool first = true;
  for (const LinearSum& sum : linear_) {
    if (!roles.has(sum.role)) continue;
    const auto add = [&](int begin, int end) {
      const auto of = sum.gradient.middleRows(begin, end - begin);
      if (g && first)
        g->middleRows(begin, end - begin) = of;
      else if (g)
        g->middleRows(begin, end - begin) += of;
      return of.cwiseProduct(x.middleRows(begin, end - begin)).sum();
    };
    value += sum.at_origin + parallel_sum(static_cast<int>(x.rows()), rows_at_once, add);
    first = false;
  }
  if (g && first) g->setZero();
  return value;
}

double LevelModel::value(const Positions& x, Roles roles) const {
  double sum = linear_value(x, nullptr, roles);
  for (const Term& term : terms_) {
    if (!term.slots || !roles.has(term.role)) continue;
    sum += term.energy->value(x);
    if (!std::isfinite(sum)) return sum;
  }
  return sum;
}

double LevelModel::gradient(const Positions& x, Positions& g, Roles roles) const {
  g.resize(x.rows(), 3);
  double sum = linear_value(x, &g, roles);
  for (const Term& term : terms_) {
    if (!term.slots || !roles.has(term.role)) continue;
    sum += add_gradient_of(*term.energy, term.name, x, g);
    if (!std::isfinite(sum)) return sum;
  }
  return sum;
}

void LevelModel::hessian(const Positions& x, Projection projection, BlockMatrix& matrix, Roles roles) const {
  matrix.set_zero();
  add_hessian(x, projection, matrix, roles, 1);
}

void LevelModel::add_hessian(const Positions& x, Projection projection, BlockMatrix& matrix, Roles roles,
                             double factor) const {
  for (const Term& term : terms_)
    if (term.slots && roles.has(term.role)) {
      BlockSink sink = term.slots->sink(matrix, factor);
      term.energy->add_hessian(x, projection, sink);
    }
}

double LevelModel::energy_gradient(const Positions& x, Positions& g) const {
  double sum = gradient(x, g);
  for (const Term& term : terms_)
    if (term.role == EnergyRole::limit) sum += add_gradient_of(*term.energy, term.name, x, g);
  return sum + add_barrier_gradient(x, g);
}

double LevelModel::add_barrier_gradient(const Positions& x, Positions& g) const {
  double sum = 0;
  for (const auto& contact : contacts_) sum += add_gradient_of(*collisions_at(*contact, x), "contact", x, g);
  return sum;
}

Eigen::VectorXd LevelModel::contact_pressure(const Positions& x) const {
  if (contacts_.empty()) return {};
  Positions g = Positions::Zero(x.rows(), 3);
  add_barrier_gradient(x, g);
  const Eigen::VectorXd area = vertex_areas({x, level_->rest.triangles});
  return (area.array() > 0).select(g.rowwise().norm().cwiseQuotient(area), 0);
}

BlockMatrix LevelModel::energy_hessian(const Positions& x, Projection projection) const {
  std::vector<std::unique_ptr<Collisions>> collisions;
  std::vector<const BoundEnergy*> energies;
  for (const Term& term : terms_)
    if (!term.is_linear()) energies.push_back(term.energy.get());
  for (const auto& contact : contacts_) {
    collisions.push_back(collisions_at(*contact, x));
    energies.push_back(collisions.back().get());
  }
  return hessian_of(energies, x, projection);
}

}  // namespace drape
