#include "core/numerics/model/position_penalty.h"

namespace drape {

double PositionPenalty::value(const Positions& x) const {
  double sum = 0;
  for (const Term& t : terms_) sum += 0.5 * t.weight * (x.row(t.vertex) - t.target.transpose()).squaredNorm();
  return sum;
}

double PositionPenalty::add_gradient(const Positions& x, Positions& g) const {
  for (const Term& t : terms_) g.row(t.vertex) += t.weight * (x.row(t.vertex) - t.target.transpose());
  return value(x);
}

Stencils PositionPenalty::stencils() const {
  Stencils own(static_cast<Eigen::Index>(terms_.size()), 1);
  for (std::size_t k = 0; k < terms_.size(); ++k) own(static_cast<Eigen::Index>(k), 0) = terms_[k].vertex;
  return own;
}

void PositionPenalty::add_hessian(const Positions&, Projection, BlockSink& sink) const {
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const double w = terms_[k].weight;
    const double block[9] = {w, 0, 0, 0, w, 0, 0, 0, w};
    sink.add(static_cast<int>(k), 0, 0, block);
  }
}

}  // namespace drape
