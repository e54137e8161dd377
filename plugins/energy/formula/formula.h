#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/kernel/interfaces/energy.h"
#include "core/kernel/plugin/config_node.h"
#include "core/kernel/plugin/declaration.h"
#include "plugins/energy/formula/law.h"

namespace drape::formula {

/// The parameters of the energy `formula`.
struct Parameters {
  std::string name = "formula";
  ElementKind per = ElementKind::triangle;
  NamedConstants constants;
  ConfigNode where;
  std::string density, energy;
  std::optional<std::string> role;

  static void declare(Declaration<Parameters>& d);
};

/// The law that they write. Throws RefusedParameters with every fault and its place.
Law read_law(const Parameters& parameters);

/// Binds a formula to all triangles of the level. Throws std::runtime_error naming a triangle without area.
std::unique_ptr<BoundEnergy> bind_membrane(const Law& law, const Level& level, const Material& material);
/// Binds a formula to a level on which the cloth buckles below the mesh: as bind_buckling_membrane does if it
/// depends on principal stretches alone, else as bind_buckling_strains does. Null for a formula of both
/// principal stretches and strains.
std::unique_ptr<BoundEnergy> bind_buckling(const Law& law, const Level& level, const Material& material,
                                           double s);
/// Binds a formula to all hinges of the level. Throws std::runtime_error naming a hinge whose triangles have
/// no area.
std::unique_ptr<BoundEnergy> bind_hinges(const Law& law, const Level& level, const Material& material);
/// Binds a formula to all vertices of the level. One that is linear in the position gives a LinearEnergy.
std::unique_ptr<BoundEnergy> bind_vertices(const Law& law, const Level& level, const Material& material);

}  // namespace drape::formula
