// Membranes of coarse levels that answer as the finest level's do: they buckle below the mesh, and give way
// at lone pins.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/numerics/elements/scaled_energy.h"
#include "core/numerics/mesh/same_entries.h"
#include "core/numerics/model/level_model.h"
#include "core/numerics/model/lone_pins.h"
#include "core/numerics/model/required.h"

namespace drape {

namespace {

/// Largest compressive stress of a coarse triangle, times its volume [J], without the finest level's share. A
/// wave between two vertices that leaves them and the surface's slopes there where they are is Euler's column
/// with clamped ends: it buckles at σ d = 4 π² D / h², h = √(2 area). The finest level, whose edges are of
/// length h_f, has longer waves itself, and so a triangle's area cancels in σ d area = 4 π² D area / (h² -
/// h_f²) wherever it is the same number of times the finest level's.
double buckling_bound(double plate_stiffness) {
  using std::numbers::pi;
  return 2 * pi * pi * plate_stiffness;
}

/// h² / (h² - h_f²) of each triangle. One that is hardly larger than the finest level's buckles as that does.
Eigen::VectorXd bound_factors(const Fineness& finest) {
  constexpr double largest = 0.9;  // ratio of areas
  return 1 / (1 - finest.areas.array().min(largest));
}

}  // namespace

LevelModel LevelModel::with_effective_membranes(const Fineness& finest,
                                                const std::vector<int>& lone_pins) const {
  double stiffness = 0;
  for (const Term& term : terms_)
    if (term.role == EnergyRole::bending) stiffness += term.kind->plate_stiffness(material_);
  const bool even = finest.areas.size() == 0;
  double s = buckling_bound(stiffness);
  if (even) s /= 1 - std::pow(4.0, -finest.levels);
  const Level& own = level_of(EnergyRole::membrane);
  std::optional<Level> effective, softened;
  if (!even) {
    effective = own;
    effective->bound_factors = bound_factors(finest);
  }
  if (!lone_pins.empty()) {
    softened = even ? own : *effective;
    softened->softening = softening_at_pins(own, lone_pins, material_.poisson_ratio, finest.levels);
  }
  // Several laws would each wrinkle by itself, also where their sum is taut.
  const bool alone = std::ranges::count(terms_, EnergyRole::membrane, &Term::role) == 1;
  LevelModel model = *this;
  for (Term& term : model.terms_) {
    if (term.role != EnergyRole::membrane) continue;
    const Stencils plain = term.energy->stencils();
    // A law of its triangle's size, whose midpoint factor is not 1, would take the softened area for its own.
    const Level& level = softened && term.kind->midpoint_factor() == 1 ? *softened
                         : effective                                   ? *effective
                                                                       : own;
    std::unique_ptr<BoundEnergy> buckling = alone ? term.kind->bind_buckling(level, material_, s) : nullptr;
    if (buckling && !same_entries(buckling->stencils(), plain))
      throw std::runtime_error("energy " + term.name +
                               ": bind_buckling must return an energy with the stencils of bind");
    term.buckles = buckling != nullptr;
    term.energy = buckling ? std::move(buckling) : term.kind->bind(level, material_);
  }
  return model;
}

std::vector<std::string> LevelModel::unbuckling_membranes() const {
  std::vector<std::string> names;
  for (const Term& term : terms_)
    if (term.role == EnergyRole::membrane && !term.buckles) names.push_back(term.name);
  return names;
}

LevelModel LevelModel::with_local_folds(const Fineness& finest, bool sharp) const {
  LevelModel model = *this;
  const bool even = finest.folds.size() == 0;
  const Eigen::VectorXd lengths =
      even ? Eigen::VectorXd::Ones(level_->hinges.rows()) : finest.relative_lengths(*level_);
  for (Term& term : model.terms_) {
    if (term.role != EnergyRole::bending) continue;
    const std::optional<double> factor = term.kind->midpoint_factor();
    if (sharp && !factor) {
      std::shared_ptr<const BoundEnergy> bound =
          term.kind->bind_sharp(*level_, material_, std::exp2(finest.levels) * lengths);
      if (bound) term.energy = std::move(bound), term.is_sharp = true;
    }
    if (even || !factor || !(*factor > 0)) continue;
    const auto bind = [&](const Level& own) { return bound_energy(*term.kind, own, material_); };
    Eigen::VectorXd factors = finest.folds;
    if (sharp) factors.array() *= lengths.array().pow(std::log2(*factor));
    term.energy = bind_with_seams(*level_, bind, factors);
    term.slots = std::make_shared<BlockSlots>(*pattern_, term.energy->stencils());
  }
  return model;
}

}  // namespace drape
