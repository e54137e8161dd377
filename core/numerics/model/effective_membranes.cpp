// Membranes of coarse levels that answer as the finest level's do: they buckle below the mesh, and give way
// at lone pins.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "core/numerics/mesh/same_entries.h"
#include "core/numerics/model/level_model.h"
#include "core/numerics/model/lone_pins.h"

namespace drape {

namespace {

/// Largest compressive stress of a coarse triangle, times its volume [J]. A wave between two vertices that
/// leaves them and the surface's slopes there where they are is Euler's column with clamped ends: it buckles
/// at σ d = 4 π² D / h², h = √(2 area). The finest level, with edges of h 2^-k, has longer waves itself, and
/// so a triangle's area cancels in σ d area = 4 π² D area / (h² - h² 4^-k).
double buckling_bound(double plate_stiffness, int levels_below) {
  using std::numbers::pi;
  return 2 * pi * pi * plate_stiffness / (1 - std::pow(4.0, -levels_below));
}

}  // namespace

LevelModel LevelModel::with_effective_membranes(int levels_below, const std::vector<int>& lone_pins) const {
  double stiffness = 0;
  for (const Term& term : terms_)
    if (term.role == EnergyRole::bending) stiffness += term.kind->plate_stiffness(material_);
  const double s = buckling_bound(stiffness, levels_below);
  std::optional<Level> softened;
  const Level& own = level_of(EnergyRole::membrane);
  if (!lone_pins.empty()) {
    softened = own;
    softened->softening = softening_at_pins(own, lone_pins, material_.poisson_ratio, levels_below);
  }
  // Several laws would each wrinkle by itself, also where their sum is taut.
  const bool alone = std::ranges::count(terms_, EnergyRole::membrane, &Term::role) == 1;
  LevelModel model = *this;
  for (Term& term : model.terms_) {
    if (term.role != EnergyRole::membrane) continue;
    const Stencils plain = term.energy->stencils();
    // A law of its triangle's size, whose midpoint factor is not 1, would take the softened area for its own.
    const Level& level = softened && term.kind->midpoint_factor() == 1 ? *softened : own;
    term.energy = alone ? term.kind->bind_buckling(level, material_, s) : term.kind->bind(level, material_);
    if (!term.energy || !same_entries(term.energy->stencils(), plain))
      throw std::runtime_error("energy " + term.name +
                               ": bind_buckling must return an energy with the stencils of bind");
  }
  return model;
}

}  // namespace drape
