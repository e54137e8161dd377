#include "core/numerics/solve/lift_off_folds.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/numerics/collision_detection/edge_crossings.h"
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

/// Where a state meets something.
struct Meetings {
  std::vector<std::array<int, 2>> layers;  // triangles of the cloth that intersect each other
  std::vector<Eigen::Vector3d> places;  // where it meets an obstacle, or, if it meets nothing, comes nearer
                                        // to something than a barrier can part
  bool intersects = false;
  std::size_t count() const { return layers.size() + places.size(); }
  bool is_fewer_than(const Meetings& other) const {
    return std::pair(intersects, count()) < std::pair(other.intersects, other.count());
  }

  Meetings(const LevelModel& model, const Positions& x) {
    constexpr double least_gap = 1e-3;  // in d̂
    for (const auto& contact : model.contacts())
      for (const Intersection& pair : contact->intersections(x))
        if (pair.triangles[1] >= 0)
          layers.push_back(pair.triangles);
        else
          places.push_back(pair.where);
    intersects = count() > 0;
    if (intersects) return;
    for (const auto& contact : model.contacts()) {
      const std::unique_ptr<Collisions> near = collisions_at(*contact, x);
      const Stencils stencils = near->stencils();
      std::vector<double> gaps;
      near->append_gaps(gaps);
      for (Eigen::Index k = 0; k < std::ssize(gaps); ++k)
        if (gaps[k] < least_gap * contact->dhat()) places.push_back(x.row(stencils.row(k).maxCoeff()));
    }
  }
};

/// The state with these pairs of triangles, which intersect, drawn apart by up to `length` [m].
Positions drawn_apart(const LevelModel& model, const std::vector<std::array<int, 2>>& pairs, double length,
                      Positions x) {
  const auto& triangles = model.level().rest.triangles;
  Positions move = Positions::Zero(x.rows(), 3);
  Eigen::ArrayXd weights = Eigen::ArrayXd::Zero(x.rows());
  const auto corners = [&](int t) { return Eigen::Matrix3d(x(triangles.row(t), Eigen::all).transpose()); };
  const auto push = [&](int v, double weight, const Eigen::RowVector3d& direction) {
    move.row(v) += weight * direction;
    weights[v] += std::abs(weight);
  };
  const auto add_edges_through = [&](int pierced, int other) {
    visit_edge_crossings(corners(other), corners(pierced), [&](const EdgeCrossing& crossing) {
      const int k = triangles(other, crossing.corner), l = triangles(other, (crossing.corner + 1) % 3);
      const auto own = triangles.row(pierced).array();
      if ((own == k || own == l).any()) return;  // they share a vertex
      const Eigen::RowVector3d away = crossing.away.transpose();
      push(k, 1 - crossing.along, away);
      push(l, crossing.along, away);
      for (int c = 0; c < 3; ++c) push(triangles(pierced, c), crossing.weights[c], -away);
    });
  };
  for (const auto& [first, second] : pairs) {
    add_edges_through(first, second);
    add_edges_through(second, first);
  }
  for (int v = 0; v < x.rows(); ++v)
    if (!model.fixed()[v]) x.row(v) += length / std::max(1.0, weights[v]) * move.row(v);
  return x;
}

}  // namespace

std::optional<Positions> lifted_off_folds(const LevelModel& model, const Positions& interpolated) {
  constexpr int rounds = 16;
  constexpr double step = 0.2, reach = 3;  // of a round's move, in edges
  constexpr int narrowness = 8;            // the fold's own vertices tell its direction
  const Level& level = model.level();
  const double edge = std::sqrt(2 * level.vertex_area.sum() / level.triangle_count());
  Positions x = interpolated, direction;
  Meetings met(model, x);
  for (int round = 0; met.count() > 0; ++round) {
    if (round == rounds) return std::nullopt;
    if (round == 0) direction = outwards(model, interpolated);
    Positions move = Positions::Zero(x.rows(), 3);
    Eigen::ArrayXd weights = Eigen::ArrayXd::Ones(x.rows());
    for (const Eigen::Vector3d& place : met.places) {
      const Eigen::ArrayXd distances = (x.rowwise() - place.transpose()).rowwise().norm();
      const Eigen::ArrayXd near = (1 - distances / (reach * edge)).max(0);
      move += near.matrix() * (near.pow(narrowness).matrix().transpose() * direction).normalized();
      weights += near;
    }
    for (int v = 0; v < level.vertex_count(); ++v)
      move.row(v) *= model.fixed()[v] ? 0 : step * edge / weights[v];
    const Positions drawn = drawn_apart(model, met.layers, step * edge, x);
    x = drawn + move;
    Meetings left(model, x);
    if (!met.places.empty() && !left.is_fewer_than(met)) {
      Positions inwards = drawn - move;
      if (Meetings other(model, inwards); other.is_fewer_than(left)) {
        x = std::move(inwards);
        left = std::move(other);
      }
    }
    met = std::move(left);
  }
  return x;
}

}  // namespace drape
