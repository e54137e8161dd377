#include "core/numerics/solve/start_fault.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/kernel/plugin/bounds.h"
#include "core/numerics/model/stretch_limit.h"

namespace drape {

namespace {

std::optional<int> first_row_not_finite(const Positions& rows) {
  for (int v = 0; v < rows.rows(); ++v)
    if (!rows.row(v).allFinite()) return v;
  return std::nullopt;
}

/// "triangle 4 (0, 1, 7)", the first without an area at x; empty if there is none.
std::string degenerate_triangle(const Triangles& triangles, const Positions& x) {
  for (int t = 0; t < triangles.rows(); ++t) {
    const auto v = triangles.row(t);
    const Eigen::RowVector3d a = x.row(v[0]), b = x.row(v[1]), c = x.row(v[2]);
    const auto length = [](const Eigen::RowVector3d& edge) { return edge.cwiseAbs().maxCoeff(); };
    const double longest = std::max({length(b - a), length(c - b), length(a - c)});
    // Neither the lengths nor the cross product may over- or underflow.
    if (longest == 0 || ((b - a) / longest).cross((c - a) / longest).norm() <= bounds::smallest_height)
      return "triangle " + std::to_string(t) + " (" + std::to_string(v[0]) + ", " + std::to_string(v[1]) +
             ", " + std::to_string(v[2]) + ")";
  }
  return "";
}

}  // namespace

std::string fault_at_start(const Objective& objective, const Positions& x, const Positions& gradient) {
  const LevelModel& model = objective.model();
  if (const std::string violation = strain_limit_violations(model.limits(), x, 1); !violation.empty())
    return violation + "; start nearer to the rest shape, or raise the limit" +
           (std::count(model.fixed().begin(), model.fixed().end(), 0) < std::ssize(model.fixed())
                ? "; pinned vertices begin at their targets: a schedule moves pins far"
                : "");
  if (const auto v = first_row_not_finite(x))
    return "vertex " + std::to_string(*v) + " has no finite position; change the start";
  std::string what;
  for (const auto& [name, joules] : model.energy_parts(x))
    if (!std::isfinite(joules)) {
      what = (name == "contact" ? "the barrier of contact" : "energy " + name) + " is not";
      break;
    }
  if (const std::string triangle = degenerate_triangle(model.level().rest.triangles, x); !triangle.empty())
    return (what.empty() ? "" : what + ", as ") + triangle + " has no area there; change the start";
  const char* const remedy = "; are the moduli, the density and the loads in SI units?";
  if (!what.empty()) return what + ", though no triangle is degenerate" + remedy;
  if (const auto v = first_row_not_finite(gradient))
    return "the forces at vertex " + std::to_string(*v) + " are not" + remedy;
  if (!std::isfinite(model.load_norm(x)))
    return "the load is too large to be computed with" + std::string(remedy);
  if (objective.is_proxy()) return "the proxy energy is not" + std::string(remedy);
  return "the forces are too large to be computed with" + std::string(remedy);
}

}  // namespace drape
