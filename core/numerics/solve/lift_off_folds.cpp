#include "core/numerics/solve/lift_off_folds.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
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
struct Meetings {
  std::vector<Eigen::Vector3d> places;
  bool intersect = false;

  static Meetings of(const LevelModel& model, const Positions& x) {
    constexpr double least_gap = 1e-3;  // in d̂
    Meetings met;
    for (const auto& contact : model.contacts())
      for (const Intersection& pair : contact->intersections(x)) met.places.push_back(pair.where);
    met.intersect = !met.places.empty();
    if (met.intersect) return met;
    for (const auto& contact : model.contacts()) {
      const std::unique_ptr<Collisions> near = collisions_at(*contact, x);
      const Stencils stencils = near->stencils();
      std::vector<double> gaps;
      near->append_gaps(gaps);
      for (Eigen::Index k = 0; k < std::ssize(gaps); ++k)
        if (gaps[k] < least_gap * contact->dhat()) met.places.push_back(mean_of(x, stencils.row(k)));
    }
    return met;
  }
  bool is_better_than(const Meetings& other) const {
    return std::pair(intersect, places.size()) < std::pair(other.intersect, other.places.size());
  }

 private:
  static Eigen::Vector3d mean_of(const Positions& x, const Eigen::RowVectorXi& stencil) {
    Eigen::Vector3d sum(0, 0, 0);
    int count = 0;
    for (const int v : stencil)
      if (v >= 0) sum += x.row(v).transpose(), ++count;
    return sum / count;
  }
};

}  // namespace

std::optional<Positions> lifted_off_folds(const LevelModel& model, const Positions& interpolated) {
  constexpr double amounts[] = {1, 2, 0.5, -0.5, -1};  // of the distances to the neighbours' means
  constexpr double reaches[] = {2, 1, 4};              // of a move around a meeting, in edges
  constexpr int rounds = 12;
  const Level& level = model.level();
  Positions x = interpolated, direction;
  Meetings met = Meetings::of(model, x);
  for (int round = 0; round < rounds && !met.places.empty(); ++round) {
    if (round == 0) direction = outwards(model, interpolated);
    Positions best = x;
    Meetings fewest = met;
    for (const double reach : reaches) {
      Eigen::VectorXd near = Eigen::VectorXd::Zero(x.rows());
      for (const Eigen::Vector3d& place : met.places)
        for (int v = 0; v < level.vertex_count(); ++v)
          if ((x.row(v).transpose() - place).squaredNorm() < reach * reach * level.vertex_area[v])
            near[v] = 1;
      for (const double amount : amounts) {
        if (fewest.places.empty()) break;
        Positions moved = x + (amount * near).asDiagonal() * direction;
        if (Meetings own = Meetings::of(model, moved); own.is_better_than(fewest))
          fewest = std::move(own), best = std::move(moved);
      }
      if (fewest.is_better_than(met)) break;
    }
    if (!fewest.is_better_than(met)) return std::nullopt;
    x = std::move(best);
    met = std::move(fewest);
  }
  if (met.places.empty()) return x;
  return std::nullopt;
}

}  // namespace drape
