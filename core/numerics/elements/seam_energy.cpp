#include "core/numerics/elements/seam_energy.h"

#include <numeric>
#include <utility>
#include <vector>

#include "core/numerics/mesh/seams.h"

namespace drape {
namespace {

/// The level with those of its hinges alone that are seams, or are none.
Level part_of(Level level, bool seams) {
  std::vector<int> own, edges;
  for (int h = 0; h < level.hinges.rows(); ++h)
    if (is_seam(level.rest, level.topology, level.hinge_edges[h]) == seams)
      own.push_back(h), edges.push_back(level.hinge_edges[h]);
  level.hinges = Stencils(level.hinges(own, Eigen::all));
  level.hinge_edges = std::move(edges);
  level.hinge_order = ElementOrder::of(level.hinges, level.rest.vertices);
  return level;
}

/// E_cloth + factor E_seams.
class SeamEnergy final : public BoundEnergy {
 public:
  SeamEnergy(std::unique_ptr<BoundEnergy> cloth, std::unique_ptr<BoundEnergy> seams, double factor)
      : cloth_(std::move(cloth)), seams_(std::move(seams)), factor_(factor) {}

  double value(const Positions& x) const override { return cloth_->value(x) + factor_ * seams_->value(x); }

  double add_gradient(const Positions& x, Positions& g) const override {
    Positions by_seams = Positions::Zero(g.rows(), 3);
    const double energy = cloth_->add_gradient(x, g) + factor_ * seams_->add_gradient(x, by_seams);
    g += factor_ * by_seams;
    return energy;
  }

  Stencils stencils() const override {
    const Stencils cloth = cloth_->stencils(), seams = seams_->stencils();
    Stencils all(cloth.rows() + seams.rows(), 4);
    if (cloth.rows() > 0) all.topRows(cloth.rows()) = cloth;
    if (seams.rows() > 0) all.bottomRows(seams.rows()) = seams;
    return all;
  }

  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override {
    constexpr int pairs = 10;
    cloth_->add_hessian(x, projection, sink);
    const auto first = static_cast<int>(cloth_->stencils().rows()),
               count = static_cast<int>(seams_->stencils().rows());
    std::vector<int> slots(static_cast<std::size_t>(count) * pairs);
    std::iota(slots.begin(), slots.end(), 0);
    std::vector<double> blocks(9 * slots.size(), 0);
    BlockSink own(slots.data(), pairs, blocks.data(), factor_);
    seams_->add_hessian(x, projection, own);
    for (int e = 0; e < count; ++e)
      for (int b = 0, k = 0; b < 4; ++b)
        for (int a = 0; a <= b; ++a, ++k)
          sink.add(first + e, a, b, &blocks[9 * (static_cast<std::size_t>(e) * pairs + k)]);
  }

 private:
  std::unique_ptr<BoundEnergy> cloth_, seams_;
  double factor_;
};

}  // namespace

std::unique_ptr<BoundEnergy> bind_with_seams(
    const Level& level, const std::function<std::unique_ptr<BoundEnergy>(const Level&)>& bind) {
  std::unique_ptr<BoundEnergy> whole = bind(level);
  if (!whole || !level.rest.sewing || level.rest.sewing->seam_stiffness == 1) return whole;
  const Stencils elements = whole->stencils();
  if (elements.rows() == 0 || elements.cols() != 4 || elements.rows() != level.hinges.rows()) return whole;
  return std::make_unique<SeamEnergy>(bind(part_of(level, false)), bind(part_of(level, true)),
                                      level.rest.sewing->seam_stiffness);
}

}  // namespace drape
