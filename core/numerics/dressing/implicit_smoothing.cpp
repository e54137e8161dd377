#include "core/numerics/dressing/implicit_smoothing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "core/kernel/interfaces/topology.h"
#include "core/numerics/linear_algebra/block_cholesky.h"
#include "core/numerics/mesh/area_vectors.h"

namespace drape {

namespace {

/// M + L over the edges of triangles, whose weights are added one by one.
class Laplacian {
 public:
  Laplacian(const Triangles& triangles, const Eigen::VectorXd& mass)
      : matrix_(BlockPattern::of(static_cast<int>(mass.size()), {Stencils(triangles)})), mass_(mass) {
    for (int i = 0; i < mass.size(); ++i) add(i, i, mass[i]);
  }

  void add_edge(int i, int j, double weight) {
    add(i, i, weight), add(j, j, weight), add(std::min(i, j), std::max(i, j), -weight);
    edges_.push_back({i, j, weight});
  }

  /// (M + L)⁻¹ M x, with the rows of x whose flag in `fixed` is set as they are.
  Positions solve(const Positions& x, const std::vector<char>& fixed) const {
    BlockCholesky factor;
    factor.analyse(matrix_.pattern, fixed);
    Positions right = mass_.asDiagonal() * x, solution;
    for (const auto& [i, j, weight] : edges_) {
      if (fixed[i]) right.row(j) += weight * x.row(i);
      if (fixed[j]) right.row(i) += weight * x.row(j);
    }
    if (!factor.factorise(matrix_, Eigen::VectorXd::Zero(mass_.size())) || !factor.solve(right, solution))
      throw std::runtime_error("the surface cannot be smoothed: its coordinates are too large or too small");
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      if (fixed[i]) solution.row(i) = x.row(i);
    return solution;
  }

 private:
  void add(int i, int j, double value) {
    double* block = matrix_.block(matrix_.pattern->find(i, j));
    for (int c = 0; c < 3; ++c) block[4 * c] += value;
  }

  struct Edge {
    int i, j;
    double weight;
  };

  BlockMatrix matrix_;
  const Eigen::VectorXd& mass_;
  std::vector<Edge> edges_;
};

}  // namespace

double surface_area(const TriangleMesh& mesh) {
  const Positions twice = area_vectors(mesh);
  double area = 0;
  for (const auto& own : twice.rowwise()) area += own.norm() / 2;
  return area;
}

Positions contracted(const TriangleMesh& mesh, double time) {
  constexpr double least_cotangent = 0.05, largest_cotangent = 5, least_share = 1e-6;
  const Positions& x = mesh.vertices;
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(x.rows());
  const auto corner = [&](Eigen::Index t, int k) -> Eigen::Vector3d {
    return x.row(mesh.triangles(t, k % 3));
  };
  const auto area_vector = [&](Eigen::Index t, int k) -> Eigen::Vector3d {
    return (corner(t, k) - corner(t, k + 2)).cross(corner(t, k + 1) - corner(t, k + 2));
  };
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    const double share = area_vector(t, 0).norm() / 6;
    for (int k = 0; k < 3; ++k) mass[mesh.triangles(t, k)] += share;
  }
  mass = mass.cwiseMax(least_share * mass.mean());  // of vertices around which all triangles are flat
  Laplacian system(mesh.triangles, mass);
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const double cosine = (corner(t, k) - corner(t, k + 2)).dot(corner(t, k + 1) - corner(t, k + 2)),
                   sine = area_vector(t, k).norm();
      const double cotangent = std::clamp(cosine, least_cotangent * sine, largest_cotangent * sine) / sine;
      system.add_edge(mesh.triangles(t, k), mesh.triangles(t, (k + 1) % 3),
                      time * (sine > 0 ? cotangent : least_cotangent) / 2);
    }
  return system.solve(x, std::vector<char>(x.rows(), 0));
}

Positions smoothed(const Triangles& triangles, const Positions& x, double time,
                   const std::vector<char>& fixed) {
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(x.rows());
  Laplacian system(triangles, ones);
  const Topology topology = Topology::of(triangles, static_cast<int>(x.rows()));
  for (const auto& edge : topology.edges.rowwise()) system.add_edge(edge[0], edge[1], time);
  return system.solve(x, fixed.empty() ? std::vector<char>(x.rows(), 0) : fixed);
}

Positions inflated(const TriangleMesh& mesh, double distance) {
  if (distance == 0) return mesh.vertices;
  constexpr double least_sum = 1e-3;  // of normals, as a part of their lengths
  const Positions areas = area_vectors(mesh);
  Positions normals = Positions::Zero(mesh.vertices.rows(), 3);
  Eigen::VectorXd lengths = Eigen::VectorXd::Zero(mesh.vertices.rows());
  for (Eigen::Index t = 0; t < areas.rows(); ++t)
    for (const int v : mesh.triangles.row(t))
      normals.row(v) += areas.row(t), lengths[v] += areas.row(t).norm();
  Positions x = mesh.vertices;
  for (Eigen::Index v = 0; v < x.rows(); ++v)
    if (const double sum = normals.row(v).norm(); sum > least_sum * lengths[v])
      x.row(v) += distance / sum * normals.row(v);
  return x;
}

}  // namespace drape
