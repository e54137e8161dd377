#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/contact_model.h"
#include "core/numerics/contact_forces/friction.h"

namespace drape {

/// The sum of several collisions of one contact model, with their elements concatenated. All stencils must
/// have four columns, all friction contacts one smoothing distance.
class CollisionStack final : public Collisions {
 public:
  explicit CollisionStack(std::vector<std::unique_ptr<Collisions>> parts) : parts_(std::move(parts)) {}

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
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      // The last part, usually by far the largest, needs no count of its rows.
      if (k > 0) first += static_cast<int>(parts_[k - 1]->stencils().rows());
      BlockSink own = sink.from(first);
      parts_[k]->add_hessian(x, projection, own);
    }
  }

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

  NormalForces normal_forces() const override {
    NormalForces forces;
    for (const auto& part : parts_) forces.add(part->normal_forces());
    return forces;
  }

  void append_gaps(std::vector<double>& gaps) const override {
    for (const auto& part : parts_) part->append_gaps(gaps);
  }

  void append_friction_contacts(FrictionContacts& groups) const override {
    for (const auto& part : parts_) part->append_friction_contacts(groups);
  }
  double friction_smoothing_distance() const override {
    double distance = 0;
    for (const auto& part : parts_) distance = std::max(distance, part->friction_smoothing_distance());
    return distance;
  }

 private:
  std::vector<std::unique_ptr<Collisions>> parts_;
};

}  // namespace drape
