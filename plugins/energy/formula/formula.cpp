#include "plugins/energy/formula/formula.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/kernel/files/message_text.h"
#include "core/kernel/plugin/plugin.h"
#include "core/kernel/plugin/refused_parameters.h"
#include "core/numerics/formulas/formula_properties.h"
#include "core/numerics/model/derivative_check.h"
#include "core/numerics/model/hessian_assembler.h"

namespace drape::formula {

void Parameters::declare(Declaration<Parameters>& d) {
  d.add("name", &Parameters::name,
        "name in results and in paths of parameters, as in energies.NAME.CONSTANT");
  d.add_choice(
      "per", &Parameters::per,
      {{"triangle", ElementKind::triangle}, {"hinge", ElementKind::hinge}, {"vertex", ElementKind::vertex}},
      "element that the formula is about; decides which symbols it has");
  d.add(constants_key, &Parameters::constants,
        "numbers with names: {NAME: 2} or {NAME: {value: 2, unit: N/m}}, in SI units")
      .between(-1e15, 1e15);
  d.add("where", &Parameters::where,
        "sub-expressions with names: {NAME: \"…\"}; each may use those above it");
  d.add("density", &Parameters::density,
        "the energy of a unit of rest area, a formula; of triangles, instead of `energy`")
      .unit("J/m²");
  d.add("energy", &Parameters::energy, "the energy of an element, a formula").unit("J");
  d.add("role", &Parameters::role,
        "what the energy is for; null: membrane for triangles, bending for hinges, external for "
        "vertices")
      .choices({"membrane", "bending", "external", "position"});
}

namespace {

EnergyRole role_of(const Parameters& p) {
  const std::string own = p.per == ElementKind::triangle ? "membrane"
                          : p.per == ElementKind::hinge  ? "bending"
                                                         : "external";
  const std::string& role = p.role ? *p.role : own;
  return role == "membrane"   ? EnergyRole::membrane
         : role == "bending"  ? EnergyRole::bending
         : role == "external" ? EnergyRole::external
                              : EnergyRole::position;
}

constexpr double cell = 0.01;  // [m]

/// Throws RefusedParameters at the key if the law cannot be compiled, or if its energy, forces or stiffness
/// on a small patch of cloth at rest are not finite.
void require_computable(const Law& law, const std::string& key, const Energy& energy) {
  const auto refuse = [&](const std::string& message) {
    const std::string& text = law.parts.back().text;
    throw RefusedParameters({{key, message, 0, with_caret(text, Fault(0, ""))}});
  };
  std::unique_ptr<BoundEnergy> bound;
  const Level level = checked_level();
  try {
    bound = energy.bind(level, Material());
  } catch (const std::length_error& error) {  // it cannot be compiled
    refuse(error.what());
  } catch (const std::exception& error) {
    if (law.depends_on_place()) return;  // the cloth may lie where it is finite: bind() looks there
    refuse(error.what());
  }
  if (law.kind == ElementKind::vertex) return;
  for (const double entry : hessian_of(*bound, level.rest.vertices, Projection::none).values)
    if (!std::isfinite(entry))
      refuse(
          "the stiffness of the rest shape is not finite: a second derivative is infinite there, as that of "
          "sqrt(x) at 0");
}

/// How far derivatives on a deformed patch are from finite differences.
std::string derivatives_remark(const Energy& energy, const Material& material) {
  try {
    const DerivativeCheck check = check_derivatives(energy, material);
    return "derivatives " + std::string(check.agrees() ? "agree with" : "DIFFER from") +
           " finite differences, forces to " + three_digits(check.gradient.error) + ", stiffness to " +
           three_digits(check.hessian.error);
  } catch (const std::exception& error) {
    return std::string("derivatives could not be checked: ") + error.what();
  }
}

/// Stress, moment or acceleration of a small patch at rest.
std::string rest_remark(const Energy& energy, ElementKind kind, const Material& material) {
  // One triangle with legs along x and y, or two about the diagonal edge of a cell.
  TriangleMesh mesh;
  mesh.vertices.resize(kind == ElementKind::hinge ? 4 : 3, 3);
  mesh.vertices.topRows(3) << 0, 0, 0, cell, 0, 0, 0, cell, 0;
  mesh.triangles.resize(kind == ElementKind::hinge ? 2 : 1, 3);
  mesh.triangles.row(0) << 0, 1, 2;
  if (kind == ElementKind::hinge) {
    mesh.vertices.row(3) << cell, cell, 0;
    mesh.triangles.row(1) << 1, 3, 2;
  }
  const Level level = Level::of(0, mesh);
  Positions g = Positions::Zero(mesh.vertices.rows(), 3);
  try {
    energy.bind(level, material)->add_gradient(level.rest.vertices, g);
  } catch (const std::exception& error) {
    return std::string("has no finite state of rest: ") + error.what();
  }
  const auto rounded = [](double value) { return three_digits(std::abs(value) < 1e-300 ? 0 : value); };
  if (kind == ElementKind::hinge) {
    const double height = cell * std::sqrt(0.5), edge = cell * std::sqrt(2.0);
    return "moment per length of a flat edge: " + rounded(g(0, 2) * height / edge) + " N";
  }
  if (kind == ElementKind::triangle)
    return "stress at rest: " + rounded(2 * g(1, 0) / cell) + ", " + rounded(2 * g(2, 1) / cell) +
           ", shear " + rounded((g(1, 1) + g(2, 0)) / cell) + " N/m";
  const Eigen::RowVector3d a = -g.colwise().sum() / (material.area_density() * cell * cell / 2);
  return "acceleration at the origin: " + rounded(a[0]) + ", " + rounded(a[1]) + ", " + rounded(a[2]) +
         " m/s²";
}

}  // namespace

/// An energy whose density is an expression in the experiment. It is parsed and checked once, compiled to a
/// program with exact derivatives on every level, and evaluated on packs of elements.
class Formula final : public Energy {
 public:
  using Parameters = formula::Parameters;

  /// Throws RefusedParameters with the place in the formula.
  explicit Formula(const Parameters& p) : law_(read_law(p)), role_(role_of(p)) {
    require_computable(law_, p.density.empty() ? "energy" : "density", *this);
  }

  /// What formulas may use, for `drape describe formula`.
  static std::string details() { return vocabulary(); }

  EnergyRole role() const override { return role_; }

  std::optional<double> midpoint_factor() const override {
    if (law_.depends_on_place()) return std::nullopt;
    // The four triangles have the strains of the whole, and a quarter of its area each.
    if (law_.per_area && !law_.uses("area")) return 1;
    const auto bound = [&](const Level& level) { return bind_unchecked(level, Material()); };
    const bool linear = bound(checked_level())->stencils().rows() == 0;
    if (law_.kind == ElementKind::vertex && !linear) return std::nullopt;
    const std::optional<double> factor = sampled_midpoint_factor(bound);
    // Another factor of a membrane would also multiply the stress at which it buckles below the mesh.
    return law_.kind == ElementKind::triangle && factor != 1.0 ? std::nullopt : factor;
  }

  double plate_stiffness(const Material& material) const override {
    if (role_ != EnergyRole::bending || law_.kind != ElementKind::hinge) return 0;
    return fold_plate_stiffness([&](const Level& level) { return bind_unchecked(level, material); });
  }

  /// Throws std::runtime_error if the energy or its forces at rest are not finite.
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override {
    auto bound = bind_unchecked(level, material);
    // Where a vertex is at rest is not where the cloth starts, and no state may lay all pieces flat.
    if (law_.kind == ElementKind::vertex || level.rest.sewing) return bound;
    Positions g = Positions::Zero(level.vertex_count(), 3);
    const double energy = bound->add_gradient(level.rest.vertices, g);
    if (!std::isfinite(energy) || !g.allFinite())
      throw std::runtime_error(std::string("the energy ") +
                               (std::isfinite(energy) ? "has forces that are" : "is") +
                               " not finite on the rest shape of level " + std::to_string(level.index));
    return bound;
  }

  std::unique_ptr<BoundEnergy> bind_buckling(const Level& level, const Material& material,
                                             double s) const override {
    return law_.kind == ElementKind::triangle ? formula::bind_buckling(law_, level, material, s) : nullptr;
  }

  /// A check of the derivatives, and the stress, moment or force at rest.
  std::vector<std::string> remarks(const Material& material) const override {
    return {derivatives_remark(*this, material), rest_remark(*this, law_.kind, material)};
  }

 private:
  std::unique_ptr<BoundEnergy> bind_unchecked(const Level& level, const Material& material) const {
    return law_.kind == ElementKind::triangle ? bind_membrane(law_, level, material)
           : law_.kind == ElementKind::hinge  ? bind_hinges(law_, level, material)
                                              : bind_vertices(law_, level, material);
  }

  Law law_;
  EnergyRole role_;
};

}  // namespace drape::formula

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::formula::Formula>(
      "formula", "An energy of triangles, hinges or vertices by a formula in the experiment.");
}
