#include "core/numerics/elements/seam_energy.h"

#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "core/numerics/mesh/seams.h"

namespace drape {
namespace {

/// The level with some of its hinges only.
Level part_of(Level level, const std::vector<int>& own) {
  std::vector<int> edges;
  for (const int h : own) edges.push_back(level.hinge_edges[h]);
  level.hinges = Stencils(level.hinges(own, Eigen::all));
  level.hinge_edges = std::move(edges);
  level.hinge_order = ElementOrder::of(level.hinges, level.rest.vertices);
  return level;
}

/// Σ factor E_group over groups of hinges.
class GroupedHinges final : public BoundEnergy {
 public:
  struct Group {
    double factor;
    std::unique_ptr<BoundEnergy> energy;
    int count;  ///< of its hinges
  };
  explicit GroupedHinges(std::vector<Group> groups) : groups_(std::move(groups)) {}

  double value(const Positions& x) const override {
    double sum = 0;
    for (const Group& group : groups_) sum += group.factor * group.energy->value(x);
    return sum;
  }

  double add_gradient(const Positions& x, Positions& g) const override {
    double sum = 0;
    for (const Group& group : groups_) {
      if (group.factor == 1) {
        sum += group.energy->add_gradient(x, g);
        continue;
      }
      Positions own = Positions::Zero(g.rows(), 3);
      sum += group.factor * group.energy->add_gradient(x, own);
      g += group.factor * own;
    }
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
      std::vector<int> slots(static_cast<std::size_t>(count) * pairs);
      std::iota(slots.begin(), slots.end(), 0);
      std::vector<double> blocks(9 * slots.size(), 0);
      BlockSink own(slots.data(), pairs, blocks.data(), group.factor);
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
  const double seams = level.rest.sewing ? level.rest.sewing->seam_stiffness : 1;
  for (int h = 0; h < level.hinges.rows(); ++h) {
    double factor = factors.size() > 0 ? std::exp2(std::round(4 * std::log2(factors[h])) / 4) : 1;
    if (seams != 1 && is_seam(level.rest, level.topology, level.hinge_edges[h])) factor *= seams;
    by_factor[factor].push_back(h);
  }
  std::vector<std::pair<double, std::vector<int>>> groups;
  if (const auto plain = by_factor.extract(1); plain) groups.emplace_back(1, std::move(plain.mapped()));
  for (auto& [factor, hinges] : by_factor) groups.emplace_back(factor, std::move(hinges));
  return groups;
}

}  // namespace

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
    groups.push_back({factor, bind(part_of(level, hinges)), static_cast<int>(hinges.size())});
  return std::make_unique<GroupedHinges>(std::move(groups));
}

}  // namespace drape
