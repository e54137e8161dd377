#include "core/numerics/mesh/flat_overlaps.h"

#include <cmath>
#include <numbers>

#include "core/kernel/interfaces/topology.h"
#include "core/numerics/mesh/mesh_faults.h"

namespace drape {
namespace {

/// The signed angle of a triangle's corner k.
double angle(const TriangleMesh& mesh, int t, int k) {
  const auto at = [&](int corner) {
    return Eigen::Vector2d(mesh.vertices.row(mesh.triangles(t, corner % 3)).head<2>());
  };
  const Eigen::Vector2d u = at(k + 1) - at(k), v = at(k + 2) - at(k);
  return std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v));
}

}  // namespace

std::vector<int> flat_overlaps(const TriangleMesh& mesh) {
  if (!(mesh.vertices.col(2).array() == 0).all()) return {};
  const Eigen::Index n = mesh.vertices.rows();
  Eigen::VectorXd up = Eigen::VectorXd::Zero(n), down = up;  // sums of the angles at each vertex
  for (int t = 0; t < mesh.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const double a = angle(mesh, t, k);
      (a > 0 ? up : down)[mesh.triangles(t, k)] += a;
    }
  for (const int h : border_half_edges(mesh.triangles, static_cast<int>(n)))
    up[HalfEdge::of(mesh.triangles, h).from] = 0;  // there the angles add up to anything
  std::vector<int> found;
  for (int t = 0; t < mesh.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.triangles(t, k);
      if (up[v] == 0 || down[v] == 0) continue;
      const double turns = (up[v] + down[v]) / (2 * std::numbers::pi);
      if (std::abs(turns) < 0.5 || (angle(mesh, t, k) > 0) == (turns > 0)) continue;
      found.push_back(t);
      break;
    }
  return found;
}

}  // namespace drape
