#include "plugins/energy/formula/rest_check.h"

#include <cmath>
#include <exception>

#include "core/kernel/files/message_text.h"
#include "core/kernel/plugin/refused_parameters.h"
#include "core/numerics/model/derivative_check.h"
#include "core/numerics/model/hessian_assembler.h"

namespace drape::formula {
namespace {

constexpr double cell = 0.01;  // [m]

}  // namespace

void require_computable(const Law& law, const std::string& key, const Energy& energy) {
  const auto refuse = [&](const std::string& message) {
    const std::string& text = law.parts.back().text;
    throw RefusedParameters({{key, message, 0, with_caret(text, Fault(0, ""))}});
  };
  std::unique_ptr<BoundEnergy> bound;
  const Level level = checked_level();
  try {
    bound = energy.bind(level, Material());
  } catch (const std::exception& error) {
    refuse(error.what());
  }
  if (law.kind == ElementKind::vertex) return;
  for (const double entry : hessian_of(*bound, level.rest.vertices, Projection::none).values)
    if (!std::isfinite(entry))
      refuse(
          "the stiffness of the rest shape is not finite: a second derivative is infinite there, as that of "
          "sqrt(x) at 0");
}

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

}  // namespace drape::formula
