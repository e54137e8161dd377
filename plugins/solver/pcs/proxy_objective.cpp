#include "proxy_objective.h"

#include <algorithm>

namespace drape {

ProxyObjective::ProxyObjective(const Problem& problem, int level, int depth)
    : Objective(*problem.models[level]),
      problem_(problem),
      level_(level),
      depth_(std::min(depth, problem.finest() - level)) {
  const int above = problem.finest() - level;
  for (int k = 0; k < above; ++k) transfers_.emplace_back(problem.hierarchy.prolongations[level + k]);
  carried_.resize(above);
  forces_.resize(above);
  matrices_.emplace_back(problem.models[level + depth_]->pattern());
  for (int k = depth_; k > 0; --k) {
    products_.emplace_back(*matrices_.back().pattern, problem.hierarchy.prolongations[level + k - 1]);
    matrices_.emplace_back(products_.back().coarse_pattern());
  }
}

const Positions& ProxyObjective::carry(const Positions& x, int count) {
  const Positions* from = &x;
  for (int k = 0; k < count; ++k) {
    transfers_[k].prolong(*from, carried_[k]);
    from = &carried_[k];
  }
  return *from;
}

double ProxyObjective::smooth_value(const Positions& x) {
  return problem_.models.back()->value(carry(x, static_cast<int>(transfers_.size())));
}

double ProxyObjective::smooth_gradient(const Positions& x, Positions& g) {
  const int above = static_cast<int>(transfers_.size());
  const double energy = problem_.models.back()->gradient(carry(x, above), forces_[above - 1]);
  for (int k = above - 1; k > 0; --k) transfers_[k].restrict(forces_[k], forces_[k - 1]);
  transfers_[0].restrict(forces_[0], g);
  return energy;
}

BlockMatrix& ProxyObjective::smooth_matrix(const Positions& x, Projection projection) {
  problem_.models[level_ + depth_]->hessian(carry(x, depth_), projection, matrices_[0]);
  for (std::size_t k = 0; k < products_.size(); ++k) products_[k].form(matrices_[k], matrices_[k + 1]);
  return matrices_.back();
}

}  // namespace drape
