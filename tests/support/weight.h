#pragma once

#include "core/kernel/interfaces/energy.h"

/// A unit weight at each vertex: constant forces, whose Hessian is zero.
class Weight : public drape::Energy, public drape::BoundEnergy {
 public:
  explicit Weight(int vertices) : vertices_(vertices) {}

  drape::EnergyRole role() const override { return drape::EnergyRole::external; }
  std::unique_ptr<drape::BoundEnergy> bind(const drape::Level&, const drape::Material&) const override {
    return std::make_unique<Weight>(*this);
  }
  double value(const drape::Positions& x) const override { return x.col(2).sum(); }
  double add_gradient(const drape::Positions& x, drape::Positions& g) const override {
    g.col(2).array() += 1;
    return value(x);
  }
  drape::Stencils stencils() const override {
    drape::Stencils s(vertices_, 1);
    for (int i = 0; i < vertices_; ++i) s(i, 0) = i;
    return s;
  }
  void add_hessian(const drape::Positions&, drape::Projection, drape::BlockSink& sink) const override {
    const double zero[9] = {};
    for (int i = 0; i < vertices_; ++i) sink.add(i, 0, 0, zero);
  }

 private:
  int vertices_;
};
