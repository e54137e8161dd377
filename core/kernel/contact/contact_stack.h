#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "core/kernel/model/contact_model.h"

namespace drape {

/// The sum of several energies, with their elements concatenated. All stencils must have four columns.
template <class Base, class Part = Base>
class Stacked : public Base {
 public:
  explicit Stacked(std::vector<std::unique_ptr<Part>> parts) : parts_(std::move(parts)) {}

  double value(const Positions& x) const override {
    double sum = 0;
    for (const auto& part : parts_) sum += part->value(x);
    return sum;
  }
  double add_gradient(const Positions& x, Positions& g) const override {
    double sum = 0;
    for (const auto& part : parts_) sum += part->add_gradient(x, g);
    return sum;
  }
  Stencils stencils() const override {
    std::vector<Stencils> own;
    Eigen::Index rows = 0;
    for (const auto& part : parts_) rows += own.emplace_back(part->stencils()).rows();
    Stencils all(rows, 4);
    rows = 0;
    for (const Stencils& s : own) {
      all.middleRows(rows, s.rows()) = s;
      rows += s.rows();
    }
    return all;
  }
  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override {
    int first = 0;
    for (const auto& part : parts_) {
      BlockSink own = sink.from(first);
      part->add_hessian(x, projection, own);
      first += static_cast<int>(part->stencils().rows());
    }
  }

 protected:
  std::vector<std::unique_ptr<Part>> parts_;
};

class FrictionStack final : public Stacked<FrictionEnergy> {
 public:
  using Stacked::Stacked;

  void append_tangential_displacements(const Positions& x,
                                       TangentialDisplacements& displacements) const override {
    for (const auto& part : parts_) part->append_tangential_displacements(x, displacements);
  }
  void append_advected_tangential_displacements(const Positions& x, const Positions& obstacle_motion,
                                                TangentialDisplacements& displacements) const override {
    for (const auto& part : parts_)
      part->append_advected_tangential_displacements(x, obstacle_motion, displacements);
  }
};

class CollisionStack final : public Stacked<Collisions> {
 public:
  using Stacked::Stacked;

  int contact_count() const override {
    int sum = 0;
    for (const auto& part : parts_) sum += part->contact_count();
    return sum;
  }
  double smallest_gap() const override {
    double gap = std::numeric_limits<double>::infinity();
    for (const auto& part : parts_) gap = std::min(gap, part->smallest_gap());
    return gap;
  }
  std::unique_ptr<FrictionEnergy> friction(const Positions& reference,
                                           const TangentialDisplacements& displacements) const override {
    std::vector<std::unique_ptr<FrictionEnergy>> frictions;
    for (const auto& part : parts_)
      if (auto own = part->friction(reference, displacements)) frictions.push_back(std::move(own));
    if (frictions.empty()) return nullptr;
    return std::make_unique<FrictionStack>(std::move(frictions));
  }
};

}  // namespace drape
