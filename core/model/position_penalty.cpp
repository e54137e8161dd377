#include "core/model/position_penalty.h"

namespace drape {

double PositionPenalty::value(const Positions& x) const {
  double sum = 0;
  for (const Pull& p : pulls_) sum += 0.5 * p.weight * (x.row(p.vertex) - p.place.transpose()).squaredNorm();
  return sum;
}

double PositionPenalty::add_gradient(const Positions& x, Positions& g) const {
  for (const Pull& p : pulls_) g.row(p.vertex) += p.weight * (x.row(p.vertex) - p.place.transpose());
  return value(x);
}

Stencils PositionPenalty::stencils() const {
  Stencils own(static_cast<Eigen::Index>(pulls_.size()), 1);
  for (std::size_t k = 0; k < pulls_.size(); ++k) own(static_cast<Eigen::Index>(k), 0) = pulls_[k].vertex;
  return own;
}

void PositionPenalty::add_hessian(const Positions&, Projection, BlockSink& sink) const {
  for (std::size_t k = 0; k < pulls_.size(); ++k) {
    const double w = pulls_[k].weight;
    const double block[9] = {w, 0, 0, 0, w, 0, 0, 0, w};
    sink.add(static_cast<int>(k), 0, 0, block);
  }
}

}  // namespace drape
