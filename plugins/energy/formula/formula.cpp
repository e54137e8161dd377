#include "plugins/energy/formula/formula.h"

#include <cmath>
#include <stdexcept>

#include "core/kernel/plugin/plugin.h"
#include "core/numerics/formulas/formula_properties.h"
#include "core/numerics/model/derivative_check.h"
#include "plugins/energy/formula/hinge.h"
#include "plugins/energy/formula/membrane.h"
#include "plugins/energy/formula/read_law.h"
#include "plugins/energy/formula/rest_check.h"
#include "plugins/energy/formula/vertex.h"

namespace drape {

using formula::ElementKind;

void Formula::Parameters::declare(Declaration<Parameters>& d) {
  d.add("name", &Parameters::name)
      .description("name in results and in paths of parameters, as in energies.NAME.CONSTANT");
  d.add_choice(
       "per", &Parameters::per,
       {{"triangle", ElementKind::triangle}, {"hinge", ElementKind::hinge}, {"vertex", ElementKind::vertex}})
      .description("element that the formula is about; decides which symbols it has");
  d.add_constants(&Parameters::constants)
      .at_least(-1e15)
      .at_most(1e15)
      .description("numbers with names: {NAME: 2} or {NAME: {value: 2, unit: N/m}}, in SI units");
  d.add_node("where", &Parameters::where)
      .description("sub-expressions with names: {NAME: \"…\"}; each may use those above it");
  d.add("density", &Parameters::density)
      .unit("J/m²")
      .description("the energy of a unit of rest area, a formula; of triangles, instead of `energy`");
  d.add("energy", &Parameters::energy).unit("J").description("the energy of an element, a formula");
  d.add("role", &Parameters::role)
      .choices({"membrane", "bending", "external", "position"})
      .description(
          "what the energy is for; null: membrane for triangles, bending for hinges, external for "
          "vertices");
}

namespace {

EnergyRole role_of(const Formula::Parameters& p) {
  const std::string own = p.per == ElementKind::triangle ? "membrane"
                          : p.per == ElementKind::hinge  ? "bending"
                                                         : "external";
  const std::string& role = p.role ? *p.role : own;
  return role == "membrane"   ? EnergyRole::membrane
         : role == "bending"  ? EnergyRole::bending
         : role == "external" ? EnergyRole::external
                              : EnergyRole::position;
}

}  // namespace

Formula::Formula(const Parameters& p) : law_(formula::read_law(p)), role_(role_of(p)) {
  formula::require_computable(law_, p.density.empty() ? "energy" : "density", *this);
}

std::optional<double> Formula::midpoint_factor() const {
  if (law_.depends_on_place()) return std::nullopt;
  // The four triangles have the strains of the whole, and a quarter of its area each.
  if (law_.per_area && !law_.uses("area")) return 1;
  const auto bound = [&](const Level& level) { return bind_unchecked(level, Material()); };
  const bool linear = bound(checked_level())->stencils().rows() == 0;
  if (law_.kind == ElementKind::vertex && !linear) return std::nullopt;
  return sampled_midpoint_factor(bound);
}

double Formula::plate_stiffness(const Material& material) const {
  if (role_ != EnergyRole::bending || law_.kind != ElementKind::hinge) return 0;
  return fold_plate_stiffness([&](const Level& level) { return bind_unchecked(level, material); });
}

std::unique_ptr<BoundEnergy> Formula::bind_unchecked(const Level& level, const Material& material) const {
  switch (law_.kind) {
    case ElementKind::triangle:
      return formula::bind_membrane(law_, level, material);
    case ElementKind::hinge:
      return formula::bind_hinges(law_, level, material);
    case ElementKind::vertex:
      break;
  }
  return formula::bind_vertices(law_, level, material);
}

std::unique_ptr<BoundEnergy> Formula::bind(const Level& level, const Material& material) const {
  auto bound = bind_unchecked(level, material);
  // Where a vertex is at rest is not where the cloth starts.
  if (law_.kind == ElementKind::vertex) return bound;
  Positions g = Positions::Zero(level.vertex_count(), 3);
  const double energy = bound->add_gradient(level.rest.vertices, g);
  if (!std::isfinite(energy) || !g.allFinite())
    throw std::runtime_error(std::string("the energy ") +
                             (std::isfinite(energy) ? "has forces that are" : "is") +
                             " not finite on the rest shape of level " + std::to_string(level.index));
  return bound;
}

std::unique_ptr<BoundEnergy> Formula::bind_buckling(const Level& level, const Material& material,
                                                    double s) const {
  return law_.kind == ElementKind::triangle ? formula::bind_buckling(law_, level, material, s)
                                            : bind(level, material);
}

std::vector<std::string> Formula::remarks(const Material& material) const {
  return {formula::derivatives_remark(*this, material), formula::rest_remark(*this, law_.kind, material)};
}

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::Formula>(
      "formula", "An energy of triangles, hinges or vertices by a formula in the experiment.");
}
