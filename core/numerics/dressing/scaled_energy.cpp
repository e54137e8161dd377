#include "core/numerics/dressing/scaled_energy.h"

#include <utility>

namespace drape {

namespace {

class BoundScaledEnergy final : public BoundEnergy {
 public:
  BoundScaledEnergy(std::unique_ptr<BoundEnergy> whole, double factor)
      : whole_(std::move(whole)), factor_(factor) {}

  double value(const Positions& x) const override { return factor_ * whole_->value(x); }
  double add_gradient(const Positions& x, Positions& g) const override {
    Positions whole = Positions::Zero(g.rows(), 3);
    const double energy = whole_->add_gradient(x, whole);
    g += factor_ * whole;
    return factor_ * energy;
  }
  Stencils stencils() const override { return whole_->stencils(); }
  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override {
    BlockSink own = sink.from(0, factor_);
    whole_->add_hessian(x, projection, own);
  }
  StepLimit max_step(const Positions& x0, const Positions& x1) const override {
    return whole_->max_step(x0, x1);
  }

 private:
  std::unique_ptr<BoundEnergy> whole_;
  double factor_;
};

class ScaledEnergy final : public Energy {
 public:
  ScaledEnergy(std::shared_ptr<const Energy> whole, double factor)
      : whole_(std::move(whole)), factor_(factor) {}

  EnergyRole role() const override { return whole_->role(); }
  std::optional<double> midpoint_factor() const override { return whole_->midpoint_factor(); }
  double plate_stiffness(const Material& material) const override {
    return factor_ * whole_->plate_stiffness(material);
  }
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override {
    std::unique_ptr<BoundEnergy> whole = whole_->bind(level, material);
    return whole ? std::make_unique<BoundScaledEnergy>(std::move(whole), factor_) : nullptr;
  }

 private:
  std::shared_ptr<const Energy> whole_;
  double factor_;
};

}  // namespace

std::shared_ptr<const Energy> scaled(std::shared_ptr<const Energy> energy, double factor) {
  if (factor == 1) return energy;
  return std::make_shared<ScaledEnergy>(std::move(energy), factor);
}

}  // namespace drape
