#include "core/numerics/hierarchy/fineness.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/hierarchy/matched_folds.h"

namespace drape {
namespace {

double rest_area(const TriangleMesh& rest, Eigen::Index t) {
  const Eigen::Matrix3d c = rest_corners(rest, t);
  return (c.col(1) - c.col(0)).cross(c.col(2) - c.col(0)).norm() / 2;
}

/// Whether level l + 1 splits each triangle of level l into four at its edges' midpoints, in any order.
bool halves_edges(const Hierarchy& hierarchy, int l) {
  if (hierarchy.splits(l)) return true;
  if (hierarchy.levels[l + 1].triangle_count() != 4 * hierarchy.levels[l].triangle_count()) return false;
  const ProlongationMatrix& weights = hierarchy.linear[l];
  for (Eigen::Index row = 0; row < weights.outerSize(); ++row)
    for (ProlongationMatrix::InnerIterator entry(weights, row); entry; ++entry)
      if (std::min(std::abs(entry.value() - 1), std::abs(entry.value() - 0.5)) > 1e-9) return false;
  return true;
}

}  // namespace

Fineness Fineness::of(const Hierarchy& hierarchy, int level) {
  const int finest = hierarchy.level_count() - 1;
  int halved = level;
  while (halved < finest && halves_edges(hierarchy, halved)) ++halved;
  if (halved == finest) return finest - level;
  const Level &own = hierarchy.levels[level], &fine = hierarchy.levels[finest];
  Fineness fineness(std::log2(static_cast<double>(fine.triangle_count()) / own.triangle_count()) / 2);
  // The finest level's triangles, a third at each corner, counted at the level's vertices that these follow.
  Eigen::MatrixX2d sums = Eigen::MatrixX2d::Zero(fine.vertex_count(), 2);
  for (int t = 0; t < fine.triangle_count(); ++t)
    for (const int v : fine.rest.triangles.row(t))
      sums.row(v) += Eigen::RowVector2d(rest_area(fine.rest, t), 1);
  for (int l = finest - 1; l >= level; --l) sums = (hierarchy.linear[l].transpose() * sums).eval();
  const double mean = fine.vertex_area.sum() / fine.triangle_count();
  fineness.areas.resize(own.triangle_count());
  for (int t = 0; t < own.triangle_count(); ++t) {
    Eigen::RowVector2d around(0, 0);
    for (const int v : own.rest.triangles.row(t)) around += sums.row(v);
    const double area = around[1] > 1 && around[0] > 0 ? around[0] / around[1] : mean;
    fineness.areas[t] = area / rest_area(own.rest, t);
  }
  fineness.folds = matched_folds(hierarchy, level);
  return fineness;
}

Eigen::VectorXd Fineness::relative_lengths(const Level& level) const {
  if (areas.size() == 0) return {};
  Eigen::VectorXd lengths(level.hinges.rows());
  for (Eigen::Index h = 0; h < lengths.size(); ++h) {
    double coarse = 0, fine = 0;
    for (const int t : level.topology.edge_triangles.row(level.hinge_edges[h])) {
      const double area = rest_area(level.rest, t);
      coarse += area;
      fine += areas[t] * area;
    }
    lengths[h] = std::sqrt(coarse / fine) / std::exp2(levels);
  }
  return lengths;
}

}  // namespace drape
