#pragma once

#include "core/kernel/interfaces/energy.h"

/// A strain limit without an energy, which allows a fixed fraction of every step.
class Limiter : public drape::Energy, public drape::BoundEnergy {
 public:
  explicit Limiter(double fraction) : fraction_(fraction) {}

  drape::EnergyRole role() const override { return drape::EnergyRole::limit; }
  std::unique_ptr<drape::BoundEnergy> bind(const drape::Level&, const drape::Material&) const override {
    return std::make_unique<Limiter>(*this);
  }
  double value(const drape::Positions&) const override { return 0; }
  double add_gradient(const drape::Positions&, drape::Positions&) const override { return 0; }
  drape::Stencils stencils() const override { return drape::Stencils(0, 1); }
  void add_hessian(const drape::Positions&, drape::Projection, drape::BlockSink&) const override {}
  drape::StepLimit max_step(const drape::Positions&, const drape::Positions&) const override {
    return {fraction_, "the limiter"};
  }

 private:
  double fraction_;
};
