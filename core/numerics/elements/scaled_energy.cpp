#include "core/numerics/elements/scaled_energy.h"

#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "core/numerics/elements/rest_hinge.h"

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

std::unique_ptr<BoundEnergy> scaled_bound(std::unique_ptr<BoundEnergy> whole, double factor) {
  if (!whole || factor == 1) return whole;
  return std::make_unique<BoundScaledEnergy>(std::move(whole), factor);
}

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
    return scaled_bound(whole_->bind(level, material), factor_);
  }

 private:
  std::shared_ptr<const Energy> whole_;
  double factor_;
};

/// The level with some of its hinges only.
Level part_of(Level level, const std::vector<int>& own) {
  std::vector<int> edges;
  for (const int h : own) edges.push_back(level.hinge_edges[h]);
  level.hinges = Stencils(level.hinges(own, Eigen::all));
  level.hinge_edges = std::move(edges);
  level.hinge_order = ElementOrder::of(level.hinges, level.rest.vertices);
  return level;
}

/// The sum over groups of hinges.
class GroupedHinges final : public BoundEnergy {
 public:
  struct Group {
    double factor;
    std::unique_ptr<BoundEnergy> energy;  ///< times the factor
    int count;                            ///< of its hinges
  };
  explicit GroupedHinges(std::vector<Group> groups) : groups_(std::move(groups)) {}

  double value(const Positions& x) const override {
    double sum = 0;
    for (const Group& group : groups_) sum += group.energy->value(x);
    return sum;
  }

  double add_gradient(const Positions& x, Positions& g) const override {
    double sum = 0;
    for (const Group& group : groups_) sum += group.energy->add_gradient(x, g);
    return sum;
  }

  Stencils stencils() const override {
    Stencils all(0, 4);
    for (const Group& group : groups_) {
      const Stencils own = group.energy->stencils();
      all.conservativeResize(all.rows() + own.rows(), 4);
      all.bottomRows(own.rows()) = own;
    }
    return all;
  }

  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override {
    constexpr int pairs = 10;
    int first = 0;
    for (const Group& group : groups_) {
      const int count = group.count;
      if (group.factor == 1) {
        BlockSink own = sink.from(first);
        group.energy->add_hessian(x, projection, own);
        first += count;
        continue;
      }
      // The sink's own factor multiplies rounded blocks: both factors at once would give other bits.
      std::vector<int> slots(static_cast<std::size_t>(count) * pairs);
      std::iota(slots.begin(), slots.end(), 0);
      std::vector<double> blocks(9 * slots.size(), 0);
      BlockSink own(slots.data(), pairs, blocks.data(), 1);
      group.energy->add_hessian(x, projection, own);
      for (int e = 0; e < count; ++e)
        for (int b = 0, k = 0; b < 4; ++b)
          for (int a = 0; a <= b; ++a, ++k)
            sink.add(first + e, a, b, &blocks[9 * (static_cast<std::size_t>(e) * pairs + k)]);
      first += count;
    }
  }

 private:
  std::vector<Group> groups_;
};

/// The hinges by their factors, ascending but for 1, which comes first.
std::vector<std::pair<double, std::vector<int>>> grouped(const Level& level, const Eigen::VectorXd& factors) {
  std::map<double, std::vector<int>> by_factor;
  for (int h = 0; h < level.hinges.rows(); ++h) {
    const double factor = factors.size() > 0 ? std::exp2(std::round(4 * std::log2(factors[h])) / 4) : 1;
    by_factor[factor * stiffness_factor(level, h)].push_back(h);
  }
  std::vector<std::pair<double, std::vector<int>>> groups;
  if (const auto plain = by_factor.extract(1); plain) groups.emplace_back(1, std::move(plain.mapped()));
  for (auto& [factor, hinges] : by_factor) groups.emplace_back(factor, std::move(hinges));
  return groups;
}

}  // namespace

std::shared_ptr<const Energy> scaled(std::shared_ptr<const Energy> energy, double factor) {
  if (factor == 1) return energy;
  return std::make_shared<ScaledEnergy>(std::move(energy), factor);
}

std::unique_ptr<BoundEnergy> bind_with_seams(
    const Level& level, const std::function<std::unique_ptr<BoundEnergy>(const Level&)>& bind,
    const Eigen::VectorXd& factors) {
  std::unique_ptr<BoundEnergy> whole = bind(level);
  const bool plain = factors.size() == 0 && (!level.rest.sewing || level.rest.sewing->seam_stiffness == 1);
  if (!whole || plain) return whole;
  const Stencils elements = whole->stencils();
  if (elements.rows() == 0 || elements.cols() != 4 || elements.rows() != level.hinges.rows()) return whole;
  std::vector<GroupedHinges::Group> groups;
  for (const auto& [factor, hinges] : grouped(level, factors))
    groups.push_back(
        {factor, scaled_bound(bind(part_of(level, hinges)), factor), static_cast<int>(hinges.size())});
  return std::make_unique<GroupedHinges>(std::move(groups));
}

}  // namespace drape
