#pragma once

#include <cmath>

#include "core/kernel/interfaces/energy.h"

/// ¼ Σ k (|x_i − a_i|² − w²)²: a bowl for w = 0, with a hump at a_i (an indefinite Hessian) otherwise.
class Wells : public drape::Energy, public drape::BoundEnergy {
 public:
  Wells(drape::Positions centres, double stiffness, double width)
      : a_(centres), k_(stiffness), w2_(width * width) {}

  drape::EnergyRole role() const override { return drape::EnergyRole::membrane; }
  std::unique_ptr<drape::BoundEnergy> bind(const drape::Level&, const drape::Material&) const override {
    return std::make_unique<Wells>(*this);
  }
  double value(const drape::Positions& x) const override {
    double sum = 0;
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      sum += 0.25 * k_ * std::pow((x - a_).row(i).squaredNorm() - w2_, 2);
    return sum;
  }
  double add_gradient(const drape::Positions& x, drape::Positions& g) const override {
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      g.row(i) += k_ * ((x - a_).row(i).squaredNorm() - w2_) * (x - a_).row(i);
    return value(x);
  }
  drape::Stencils stencils() const override {
    drape::Stencils s(a_.rows(), 1);
    for (int i = 0; i < a_.rows(); ++i) s(i, 0) = i;
    return s;
  }
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
