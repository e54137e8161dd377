#include "core/numerics/model/lone_pins.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace drape {

namespace {

bool has_fixed_neighbour(const LevelModel& model, int vertex) {
  return std::ranges::any_of(model.level().topology.vertex_vertices.row(vertex),
                             [&](int v) { return model.fixed()[v] != 0; });
}

/// K / (E d θ) of the triangles around a vertex [1], by linear elasticity in plane stress.
double relative_stiffness(const Level& level, int vertex, double poisson_ratio) {
  const double nu = poisson_ratio;
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  // the sum of all directions in the cloth
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  bool in_one_piece = true;  // pieces have no direction in common
  double angle = 0;
  for (const int t : level.topology.vertex_triangles.row(vertex)) {
    const auto named = level.rest.triangles.row(t);
    const int k = named[0] == vertex ? 0 : named[1] == vertex ? 1 : 2;
    const Eigen::Matrix3d corners = rest_corners(level.rest, t);
    const auto at = [&](int i) -> Eigen::Vector3d { return corners.col((k + i) % 3); };
    if (angle == 0) place = at(0);
    in_one_piece = in_one_piece && (!level.rest.sewing || at(0) == place);
    const Eigen::Vector3d e1 = at(1) - at(0), e2 = at(2) - at(0), doubled = e1.cross(e2),
                          normal = doubled.normalized(),
                          slope = normal.cross(e2 - e1) / doubled.norm();  // of the vertex's hat function
    const Eigen::Matrix3d in_plane = Eigen::Matrix3d::Identity() - normal * normal.transpose();
    stiffness += doubled.norm() / 4 / (1 - nu * nu) *
                 ((1 + nu) * slope * slope.transpose() + (1 - nu) * slope.squaredNorm() * in_plane);
    const double own = std::atan2(doubled.norm(), e1.dot(e2));
    axis += std::tan(own / 2) * (e1.normalized() + e2.normalized());
    angle += own;
  }
  if (!level.topology.on_border[vertex])
    return stiffness.trace() / 2 * (3 - nu) * (1 + nu) / (4 * std::numbers::pi);
  const double theta = (angle + std::sin(angle)) / 2, length = axis.squaredNorm();
  const bool has_axis = in_one_piece && length >= 1e-6;  // a full turn has none
  return (!has_axis ? stiffness.trace() / 2 : axis.dot(stiffness * axis) / length) / theta;
}

}  // namespace

std::vector<int> lone_pins(const LevelModel& coarse,
                           const std::function<std::shared_ptr<const LevelModel>()>& finest) {
  std::vector<int> lone;
  for (const DirichletVertex& d : coarse.dirichlet())
    if (!has_fixed_neighbour(coarse, d.vertex)) lone.push_back(d.vertex);
  if (lone.empty()) return lone;
  const std::shared_ptr<const LevelModel> fine = finest();
  std::erase_if(lone,
                [&](int vertex) { return has_fixed_neighbour(*fine, coarse.level().cloth_vertex(vertex)); });
  return lone;
}

Eigen::VectorXd softening_at_pins(const Level& level, const std::vector<int>& pins, double poisson_ratio,
                                  double levels_below) {
  Eigen::VectorXd softening = Eigen::VectorXd::Ones(level.triangle_count());
  for (const int vertex : pins) {
    const double compliance =
        1 + relative_stiffness(level, vertex, poisson_ratio) * levels_below * std::numbers::ln2;
    for (const int t : level.topology.vertex_triangles.row(vertex)) softening[t] = 1 / compliance;
  }
  return softening;
}

}  // namespace drape
