#include "core/numerics/mesh/flat_pieces.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "core/numerics/mesh/disjoint_sets.h"
#include "core/numerics/mesh/seams.h"
#include "core/numerics/mesh/texture_coordinates.h"

namespace drape {

std::vector<int> flat_pieces(const TriangleMesh& mesh, const Topology& topology) {
  DisjointSets sets(static_cast<int>(mesh.triangles.rows()));
  for (int e = 0; e < topology.edges.rows(); ++e)
    if (topology.edge_triangles(e, 1) != -1 && !is_seam(mesh, topology, e))
      sets.unite(topology.edge_triangles(e, 0), topology.edge_triangles(e, 1));
  return sets.numbered();
}

std::vector<int> connected_parts(const TriangleMesh& mesh) {
  DisjointSets sets(static_cast<int>(mesh.triangles.rows()));
  std::vector<int> first(mesh.vertices.rows(), -1);  // triangle of each vertex
  for (int t = 0; t < mesh.triangles.rows(); ++t)
    for (const int v : mesh.triangles.row(t))
      if (first[v] < 0)
        first[v] = t;
      else
        sets.unite(t, first[v]);
  return sets.numbered();
}

Positions flat_directions(const TriangleMesh& mesh, GrainAxis along, const Eigen::VectorXd& degrees) {
  const Eigen::RowVector3d axis =
      along == GrainAxis::u ? Eigen::RowVector3d(1, 0, 0) : Eigen::RowVector3d(0, 1, 0);
  Positions warp(mesh.triangles.rows(), 3);
  for (Eigen::Index t = 0; t < warp.rows(); ++t) {
    const double angle = degrees[t] * std::numbers::pi / 180;
    const Eigen::RowVector3d from =
        along == GrainAxis::file && mesh.warp.rows() > 0 ? mesh.warp.row(t) : axis;
    warp.row(t) = std::cos(angle) * from + std::sin(angle) * Eigen::RowVector3d(-from.y(), from.x(), 0);
  }
  return warp;
}

UvLength UvLength::of(const TriangleMesh& mesh, const std::vector<char>& marked) {
  double area = 0, flat_area = 0, u = 0, v = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    if (!marked[t]) continue;
    Eigen::Matrix2d flat;
    flat << mesh.uv(t, 2) - mesh.uv(t, 0), mesh.uv(t, 4) - mesh.uv(t, 0), mesh.uv(t, 3) - mesh.uv(t, 1),
        mesh.uv(t, 5) - mesh.uv(t, 1);
    if (!(std::abs(flat.determinant()) > 1e-12 * flat.squaredNorm())) continue;
    Eigen::Matrix<double, 3, 2> edges;
    for (int k = 0; k < 2; ++k)
      edges.col(k) = mesh.vertices.row(mesh.triangles(t, k + 1)) - mesh.vertices.row(mesh.triangles(t, 0));
    const Eigen::Matrix<double, 3, 2> f = edges * flat.inverse();
    const double own = std::abs(flat.determinant()) / 2;
    area += edges.col(0).cross(edges.col(1)).norm() / 2, flat_area += own;
    u += own * f.col(0).squaredNorm(), v += own * f.col(1).squaredNorm();
  }
  return {std::sqrt(area / flat_area), std::sqrt(u / flat_area), std::sqrt(v / flat_area)};
}

bool similar_lengths(double a, double b) { return a < 1.1 * b && b < 1.1 * a; }

double scale_to_picture(TriangleMesh& mesh) {
  if (!mesh.sewing) return 0;
  Eigen::Map<UvVertices::Coordinates> uv(mesh.uv.data(), 3 * mesh.uv.rows(), 2);
  const Eigen::RowVector2d low = uv.colwise().minCoeff();
  const double extent = (uv.colwise().maxCoeff() - low).maxCoeff();
  uv = ((uv.rowwise() - low) / extent).eval();
  return extent * mesh.sewing->uv_length;
}

}  // namespace drape
