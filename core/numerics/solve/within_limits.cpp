#include "core/numerics/solve/within_limits.h"

#include "core/numerics/elements/stretch.h"
#include "core/numerics/model/stretch_limit.h"

namespace drape {
namespace {

/// Adds the moves of a triangle's corners, about its centroid, that shorten its stretches to `most`.
void add_shortening(const Level& level, const Positions& x, int t, double most, Positions& moves) {
  const auto v = level.rest.triangles.row(t);
  const RestTriangle rest = RestTriangle::of(level, t);
  const PrincipalStretch<double> stretch =
      rest.stretch((x.row(v[1]) - x.row(v[0])).transpose(), (x.row(v[2]) - x.row(v[0])).transpose());
  Eigen::Matrix3d corners = Eigen::Matrix3d::Zero();  // one a column, less where they are
  const auto shorten = [&](double value, const Eigen::Vector3d& w, double along, double across) {
    if (!(value > most)) return;
    const Eigen::Vector2d side1(1 / rest.a, 0), side2(-rest.b / (rest.a * rest.c), 1 / rest.c);
    const Eigen::Vector2d direction(along, across);
    corners.col(1) += (most / value - 1) * direction.dot(side1) * w;
    corners.col(2) += (most / value - 1) * direction.dot(side2) * w;
  };
  shorten(stretch.largest, stretch.w1, stretch.cosine, stretch.sine);
  shorten(stretch.smallest, stretch.w2, -stretch.sine, stretch.cosine);
  corners.colwise() -= corners.rowwise().mean().eval();
  for (int k = 0; k < 3; ++k) moves.row(v[k]) += corners.col(k).transpose();
}

}  // namespace

Positions within_limits(const LevelModel& model, Positions x) {
  constexpr int sweeps = 40;
  constexpr double margin = 0.5;  // of the limit's strain, so that few triangles are moved again
  const Level& level = model.level();
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    Positions moves = Positions::Zero(x.rows(), 3);
    Eigen::VectorXi counts = Eigen::VectorXi::Zero(x.rows());
    for (const BoundEnergy* energy : model.limits())
      if (const StretchLimited* limit = energy->stretch_limit())
        for (const StretchedTriangle& stretched : limit->violations(x)) {
          add_shortening(level, x, stretched.triangle, 1 + margin * (limit->limit() - 1), moves);
          for (const int v : level.rest.triangles.row(stretched.triangle)) ++counts[v];
        }
    if (counts.isZero()) break;
    for (int v = 0; v < level.vertex_count(); ++v)
      if (counts[v] > 0 && !model.fixed()[v]) x.row(v) += moves.row(v) / counts[v];
  }
  return x;
}

}  // namespace drape
