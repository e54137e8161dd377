#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/kernel/interfaces/energy.h"
#include "core/kernel/plugin/parameters.h"
#include "plugins/energy/formula/law.h"

namespace drape {
namespace formula {

/// Binds a formula to all triangles of the level. Throws std::runtime_error naming a triangle without area.
std::unique_ptr<BoundEnergy> bind_membrane(const Law& law, const Level& level, const Material& material);
/// Binds a formula to a level on which the cloth buckles below the mesh: as bind_buckling_membrane does if it
/// depends on principal stretches alone, else as bind_buckling_strains does. A formula of both principal
/// stretches and strains keeps its plain energy.
std::unique_ptr<BoundEnergy> bind_buckling(const Law& law, const Level& level, const Material& material,
                                           double s);
/// Binds a formula to all hinges of the level. Throws std::runtime_error naming a hinge whose triangles have
/// no area.
std::unique_ptr<BoundEnergy> bind_hinges(const Law& law, const Level& level, const Material& material);
/// Binds a formula to all vertices of the level. One that is linear in the position gives a LinearEnergy.
std::unique_ptr<BoundEnergy> bind_vertices(const Law& law, const Level& level, const Material& material);

}  // namespace formula

/// An energy whose density is an expression in the experiment. It is parsed and checked once, compiled to a
/// program with exact derivatives on every level, and evaluated on packs of elements.
class Formula final : public Energy {
 public:
  struct Parameters {
    std::string name = "formula";
    formula::ElementKind per = formula::ElementKind::triangle;
    NamedConstants constants;
    ConfigNode where;
    std::string density, energy;
    std::optional<std::string> role;

    static void declare(Declaration<Parameters>& d);
    /// The law that they write. Throws RefusedParameters with every fault and its place.
    formula::Law law() const;
  };

  /// Throws RefusedParameters with the place in the formula.
  explicit Formula(const Parameters& parameters);

  /// What formulas may use, for `drape describe formula`.
  static std::string details() { return formula::vocabulary(); }

  EnergyRole role() const override { return role_; }
  std::optional<double> midpoint_factor() const override;
  double plate_stiffness(const Material& material) const override;
  /// Throws std::runtime_error if the energy or its forces at rest are not finite.
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override;
  std::unique_ptr<BoundEnergy> bind_buckling(const Level& level, const Material& material,
                                             double s) const override;
  /// A check of the derivatives, and the stress, moment or force at rest.
  std::vector<std::string> remarks(const Material& material) const override;

 private:
  std::unique_ptr<BoundEnergy> bind_unchecked(const Level& level, const Material& material) const;

  formula::Law law_;
  EnergyRole role_;
};

}  // namespace drape
