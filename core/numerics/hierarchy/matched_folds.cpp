#include "core/numerics/hierarchy/matched_folds.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/numerics/mesh/seams.h"

namespace drape {
namespace {

/// Symmetric matrices as vectors whose products are those of the matrices (Mandel's notation), since pieces
/// lie anywhere in space; a hinge knows its own plane.
using Symmetric = Eigen::Matrix<double, 6, 1>;

Symmetric vector_of(const Eigen::Matrix3d& m) {
  const double r = std::sqrt(2.0);
  return {m(0, 0), m(1, 1), m(2, 2), r * m(1, 2), r * m(0, 2), r * m(0, 1)};
}

/// How a hinge of flat cloth answers curvature.
struct BentHinge {
  /// a: where the cloth has curvatures K [1/m], the hinge's angle is a · K √area / ‖ē‖ [rad], and its energy
  /// (a · K)², but for the bending stiffness. 0 at seams, which join planes.
  Symmetric angle = Symmetric::Zero();
  Eigen::Matrix<double, 6, 3> plane = Eigen::Matrix<double, 6, 3>::Zero();  ///< basis of K in its plane
  double area = 0;                                                          ///< of its triangles [m²]

  BentHinge(const Level& level, Eigen::Index hinge) {
    const int edge = level.hinge_edges[hinge];
    if (level.rest.sewing && is_seam(level.rest, level.topology, edge)) return;
    const int s = level.topology.edge_triangles(edge, 0), t = level.topology.edge_triangles(edge, 1);
    const int k = level.topology.corner_opposite(edge, s);
    const Eigen::Matrix3d c = rest_corners(level.rest, s);
    const Eigen::Vector3d from = c.col((k + 1) % 3), side = c.col((k + 2) % 3) - from, p = c.col(k) - from,
                          q = rest_corners(level.rest, t).col(level.topology.corner_opposite(edge, t)) - from;
    // Along the edge (e) and across it (n): the angle between the planes through a parabola's points.
    const double length = side.norm();
    const Eigen::Vector3d e = side / length;
    const double pe = p.dot(e), qe = q.dot(e), pn = (p - pe * e).norm(), qn = (q - qe * e).norm();
    const Eigen::Vector3d n = (p - pe * e) / pn;
    const Eigen::Matrix3d ee = e * e.transpose(), nn = n * n.transpose(),
                          both = e * n.transpose() + n * e.transpose();
    area = length * (pn + qn) / 2;
    angle = length / std::sqrt(area) *
            vector_of((pn + qn) / 2 * nn + (pe - qe) / 2 * both +
                      (pe * (pe - length) / pn + qe * (qe - length) / qn) / 2 * ee);
    plane << vector_of(ee), vector_of(nn), vector_of(both / std::sqrt(2.0));
  }
};

/// Around each vertex, a row each: the sum over hinges of factor × angle angleᵀ (36), and of their areas.
Eigen::MatrixXd bending_around(const Level& level, const std::vector<BentHinge>& hinges,
                               const Eigen::VectorXd& factors) {
  Eigen::MatrixXd around = Eigen::MatrixXd::Zero(level.vertex_count(), 37);
  for (Eigen::Index h = 0; h < level.hinges.rows(); ++h) {
    Eigen::Matrix<double, 1, 37> own;
    own << (factors[h] * hinges[h].angle * hinges[h].angle.transpose()).eval().reshaped().transpose(),
        hinges[h].area;
    for (const int v : level.hinges.row(h)) around.row(v) += own;
  }
  return around;
}

/// The energy per area ½ KᵀBK around a hinge, K in its plane: B, over the bending stiffness.
Eigen::Matrix3d bending_at(const Eigen::MatrixXd& around, const Level& level, Eigen::Index h,
                           const BentHinge& hinge) {
  const Eigen::Matrix<double, 1, 37> sum = around(level.hinges.row(h), Eigen::all).colwise().sum();
  return hinge.plane.transpose() * Eigen::Map<const Eigen::Matrix<double, 6, 6>>(sum.data()) * hinge.plane /
         sum[36];
}

std::vector<BentHinge> bent_hinges(const Level& level) {
  std::vector<BentHinge> hinges;
  for (Eigen::Index h = 0; h < level.hinges.rows(); ++h) hinges.emplace_back(level, h);
  return hinges;
}

}  // namespace

Eigen::VectorXd matched_folds(const Hierarchy& hierarchy, int level) {
  constexpr int rounds = 3;  // later ones change single hinges more than what a neighbourhood resists
  constexpr double most = 10;
  const Level &own = hierarchy.levels[level], &fine = hierarchy.levels.back();
  Eigen::MatrixXd wanted = bending_around(fine, bent_hinges(fine), Eigen::VectorXd::Ones(fine.hinges.rows()));
  for (int l = hierarchy.level_count() - 2; l >= level; --l)
    wanted = (hierarchy.linear[l].transpose() * wanted).eval();
  const std::vector<BentHinge> hinges = bent_hinges(own);
  Eigen::VectorXd factors = Eigen::VectorXd::Ones(own.hinges.rows());
  for (int round = 0; round < rounds; ++round) {
    // Raises −log det B − tr(B⁻¹ wanted), whose maximum is B = wanted where positive factors reach that.
    const Eigen::MatrixXd around = bending_around(own, hinges, factors);
    for (Eigen::Index h = 0; h < factors.size(); ++h) {
      const Eigen::Vector3d a = hinges[h].plane.transpose() * hinges[h].angle,
                            k = bending_at(around, own, h, hinges[h]).ldlt().solve(a);
      const double ratio = k.dot(bending_at(wanted, own, h, hinges[h]) * k) / a.dot(k);
      if (ratio > 0 && std::isfinite(ratio)) factors[h] = std::clamp(factors[h] * ratio, 1 / most, most);
    }
  }
  return factors;
}

}  // namespace drape
