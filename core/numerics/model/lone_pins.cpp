#include "core/numerics/model/lone_pins.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace drape {

namespace {

std::map<int, int> vertices_by_pin(const LevelModel& model) {
  std::map<int, int> counts;
  for (const DirichletVertex& d : model.dirichlet()) ++counts[d.pin];
  return counts;
}

/// K / (E d θ) of the triangles around a vertex [1], by linear elasticity in plane stress.
double relative_stiffness(const Level& level, int vertex, double poisson_ratio) {
  const AdjacencyList& around = level.topology.vertex_triangles;
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  // of the angle; none of a full turn
  double angle = 0;
  for (const int* t = around.begin(vertex); t != around.end(vertex); ++t) {
    const auto corners = level.rest.triangles.row(*t);
    const int k = corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2;
    const auto at = [&](int i) -> Eigen::Vector3d { return level.rest.vertices.row(corners[(k + i) % 3]); };
    const Eigen::Vector3d e1 = at(1) - at(0), e2 = at(2) - at(0), doubled = e1.cross(e2),
                          normal = doubled.normalized(),
                          slope = normal.cross(e2 - e1) / doubled.norm();  // of the vertex's hat function
    const Eigen::Matrix3d in_plane = Eigen::Matrix3d::Identity() - normal * normal.transpose();
    stiffness += doubled.norm() / 4 / (1 - poisson_ratio * poisson_ratio) *
                 ((1 + poisson_ratio) * slope * slope.transpose() +
                  (1 - poisson_ratio) * slope.squaredNorm() * in_plane);
    axis += doubled.norm() * slope;
    angle += std::atan2(doubled.norm(), e1.dot(e2));
  }
  const double theta = (angle + std::sin(angle)) / 2;
  if (!level.topology.on_border[vertex]) return stiffness.trace() / 2 / theta;
  return axis.dot(stiffness * axis) / axis.squaredNorm() / theta;
}

}  // namespace

std::vector<int> lone_pins(const LevelModel& coarse, const LevelModel& finest) {
  const std::map<int, int> here = vertices_by_pin(coarse), there = vertices_by_pin(finest);
  const AdjacencyList& neighbours = coarse.level().topology.vertex_vertices;
  std::vector<int> lone;
  for (const DirichletVertex& d : coarse.dirichlet()) {
    const auto on_finest = there.find(d.pin);
    if (on_finest != there.end() && on_finest->second == here.at(d.pin) &&
        std::none_of(neighbours.begin(d.vertex), neighbours.end(d.vertex),
                     [&](int v) { return coarse.fixed()[v]; }))
      lone.push_back(d.vertex);
  }
  return lone;
}

Eigen::VectorXd softening_at_pins(const Level& level, const std::vector<int>& pins, double poisson_ratio,
                                  int levels_below) {
  Eigen::VectorXd softening = Eigen::VectorXd::Ones(level.triangle_count());
  const AdjacencyList& around = level.topology.vertex_triangles;
  for (const int vertex : pins) {
    const double compliance =
        1 + relative_stiffness(level, vertex, poisson_ratio) * levels_below * std::numbers::ln2;
    for (const int* t = around.begin(vertex); t != around.end(vertex); ++t) softening[*t] = 1 / compliance;
  }
  return softening;
}

}  // namespace drape
