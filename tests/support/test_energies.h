#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/energy.h"

// Small energies for tests of what works with any.

/// Nothing, and the base of what is something.
struct NoEnergy : drape::BoundEnergy {
  double value(const drape::Positions&) const override { return 0; }
  double add_gradient(const drape::Positions& x, drape::Positions&) const override { return value(x); }
  drape::Stencils stencils() const override { return drape::Stencils(0, 1); }
  void add_hessian(const drape::Positions&, drape::Projection, drape::BlockSink&) const override {}
};

/// Makes copies of a bound energy, whatever the level.
template <class Bound>
class CopyingEnergy : public drape::Energy {
 public:
  CopyingEnergy(Bound bound, drape::EnergyRole role) : bound_(std::move(bound)), role_(role) {}
  drape::EnergyRole role() const override { return role_; }
  std::unique_ptr<drape::BoundEnergy> bind(const drape::Level&, const drape::Material&) const override {
    return std::make_unique<Bound>(bound_);
  }

 private:
  Bound bound_;
  drape::EnergyRole role_;
};

template <class Bound>
std::shared_ptr<drape::Energy> energy_of(Bound bound, drape::EnergyRole role = drape::EnergyRole::membrane) {
  return std::make_shared<CopyingEnergy<Bound>>(std::move(bound), role);
}

/// An element for each of n vertices.
inline drape::Stencils each_vertex(Eigen::Index n) { return Eigen::VectorXi::LinSpaced(n, 0, int(n) - 1); }

/// ¼ Σ k (|x_i − a_i|² − w²)²: a bowl for w = 0, with a hump at a_i (an indefinite Hessian) otherwise.
class Wells : public NoEnergy {
 public:
  Wells(drape::Positions centres, double stiffness, double width)
      : a_(std::move(centres)), k_(stiffness), w2_(width * width) {}

  double value(const drape::Positions& x) const override {
    return 0.25 * k_ * ((x - a_).rowwise().squaredNorm().array() - w2_).square().sum();
  }
  double add_gradient(const drape::Positions& x, drape::Positions& g) const override {
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      g.row(i) += k_ * ((x - a_).row(i).squaredNorm() - w2_) * (x - a_).row(i);
    return value(x);
  }
  drape::Stencils stencils() const override { return each_vertex(a_.rows()); }
  void add_hessian(const drape::Positions& x, drape::Projection projection,
                   drape::BlockSink& sink) const override {
    for (int i = 0; i < a_.rows(); ++i) {
      const Eigen::Vector3d d = (x - a_).row(i);
      const double away = projection.map(k_ * (d.squaredNorm() - w2_));
      const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> h =
          away * Eigen::Matrix3d::Identity() + 2 * k_ * d * d.transpose();
      sink.add(i, 0, 0, h.data());
    }
  }

 private:
  drape::Positions a_;
  double k_, w2_;
};

/// Σ ½ k |x_a − x_b|² over pairs, of which it has the Hessian alone. A partner of -1 is the origin.
struct PairSprings : NoEnergy {
  struct Pair {
    int a, b;
    double stiffness = 1;
  };
  std::vector<Pair> pairs;

  explicit PairSprings(std::vector<Pair> of) : pairs(std::move(of)) {}
  drape::Stencils stencils() const override {
    drape::Stencils s(pairs.size(), 2);
    for (std::size_t e = 0; e < pairs.size(); ++e) s.row(e) << pairs[e].a, pairs[e].b;
    return s;
  }
  void add_hessian(const drape::Positions&, drape::Projection, drape::BlockSink& sink) const override {
    for (std::size_t e = 0; e < pairs.size(); ++e)
      for (const auto& [a, b] : {std::pair(0, 0), std::pair(0, 1), std::pair(1, 1)}) {
        const double k = a == b ? pairs[e].stiffness : -pairs[e].stiffness;
        const double h[9] = {k, 0, 0, 0, k, 0, 0, 0, k};
        sink.add(e, a, b, h);
      }
  }
};

/// A unit weight at each vertex.
struct Weight : NoEnergy {
  double value(const drape::Positions& x) const override { return x.col(2).sum(); }
  double add_gradient(const drape::Positions& x, drape::Positions& g) const override {
    g.col(2).array() += 1;
    return value(x);
  }
};

/// A limit that allows a fixed fraction of every step.
struct Limiter : NoEnergy {
  explicit Limiter(double allowed) : fraction(allowed) {}
  drape::StepLimit max_step(const drape::Positions&, const drape::Positions&) const override {
    return {fraction, "the limiter"};
  }
  double fraction;
};
