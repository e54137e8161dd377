#include "core/numerics/solve/lift_off_folds.h"

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <vector>

#include "core/numerics/model/required.h"

namespace drape {
namespace {

/// The distance from each vertex to a mean of its neighbours whose weights give the rest shape's plane back
/// (cotangents): 0 within a coarse triangle, on a fold towards its outer side. n×3 [m], 0 at fixed vertices
/// and at borders, where the weights do not give a plane back.
Positions outwards(const LevelModel& model, const Positions& x) {
  const Level& level = model.level();
  Positions sums = Positions::Zero(x.rows(), 3);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(x.rows());
  for (int t = 0; t < level.triangle_count(); ++t) {
    const Eigen::Matrix3d c = rest_corners(level.rest, t);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d a = c.col((k + 1) % 3) - c.col(k), b = c.col((k + 2) % 3) - c.col(k);
      const double cotangent = a.dot(b) / a.cross(b).norm();
      const int i = level.rest.triangles(t, (k + 1) % 3), j = level.rest.triangles(t, (k + 2) % 3);
      sums.row(i) += cotangent * (x.row(i) - x.row(j));
      sums.row(j) += cotangent * (x.row(j) - x.row(i));
      for (const int v : {i, j}) weights[v] += std::abs(cotangent);
    }
  }
  for (int v = 0; v < level.vertex_count(); ++v)
    if (model.fixed()[v] || level.topology.on_border[v])
      sums.row(v).setZero();
    else
      sums.row(v) /= weights[v];
  return sums;
}

/// Where a state meets something, or, if nowhere, comes nearer than a barrier can part: edges of two layers
/// may lie in the plane of one coarse triangle.
std::vector<Eigen::Vector3d> meetings(const LevelModel& model, const Positions& x) {
  constexpr double least_gap = 1e-3;  // in d̂
  std::vector<Eigen::Vector3d> places;
  for (const auto& contact : model.contacts())
    for (const Intersection& pair : contact->intersections(x)) places.push_back(pair.where);
  if (!places.empty()) return places;
  for (const auto& contact : model.contacts()) {
    const std::unique_ptr<Collisions> near = collisions_at(*contact, x);
    const Stencils stencils = near->stencils();
    std::vector<double> gaps;
    near->append_gaps(gaps);
    for (Eigen::Index k = 0; k < std::ssize(gaps); ++k)
      if (gaps[k] < least_gap * contact->dhat()) places.push_back(x.row(stencils.row(k).maxCoeff()));
  }
  return places;
}

}  // namespace

std::optional<Positions> lifted_off_folds(const LevelModel& model, const Positions& interpolated) {
  constexpr int rounds = 12, outward_rounds = 4;
  constexpr double step = 0.2, reach = 3;  // of a round's move, in edges
  constexpr int narrowness = 8;            // the fold's own vertices tell its direction
  const Level& level = model.level();
  const double edge = std::sqrt(2 * level.vertex_area.sum() / level.triangle_count());
  Positions x = interpolated, direction;
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Eigen::Vector3d> places = meetings(model, x);
    if (places.empty()) return x;
    if (round == 0) direction = outwards(model, interpolated);
    Positions move = Positions::Zero(x.rows(), 3);
    Eigen::ArrayXd weights = Eigen::ArrayXd::Ones(x.rows());
    for (const Eigen::Vector3d& place : places) {
      const Eigen::ArrayXd distances = (x.rowwise() - place.transpose()).rowwise().norm();
      const Eigen::ArrayXd near = (1 - distances / (reach * edge)).max(0);
      move += near.matrix() * (near.pow(narrowness).matrix().transpose() * direction).normalized();
      weights += near;
    }
    const double length = (round < outward_rounds ? step : -step) * edge;
    for (int v = 0; v < level.vertex_count(); ++v)
      if (!model.fixed()[v]) x.row(v) += length / weights[v] * move.row(v);
  }
  return std::nullopt;
}

}  // namespace drape
