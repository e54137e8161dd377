#include "core/numerics/mesh/seams.h"

#include <Eigen/Geometry>
#include <utility>

namespace drape {

RestSide rest_side(const TriangleMesh& mesh, const Topology& topology, int edge, int side) {
  const int t = topology.edge_triangles(edge, side), k = topology.corner_opposite(edge, t);
  const Eigen::Matrix3d corners = rest_corners(mesh, t);
  RestSide own{corners.col((k + 1) % 3), corners.col((k + 2) % 3), corners.col(k)};
  if (side == 1) std::swap(own.from, own.to);
  return own;
}

double rest_length(const TriangleMesh& mesh, const Topology& topology, int edge) {
  const RestSide first = rest_side(mesh, topology, edge, 0);
  const double length = (first.to - first.from).norm();
  if (!mesh.sewing || topology.edge_triangles(edge, 1) == -1) return length;
  const RestSide second = rest_side(mesh, topology, edge, 1);
  return (length + (second.to - second.from).norm()) / 2;
}

bool is_seam(const TriangleMesh& mesh, const Topology& topology, int edge) {
  if (!mesh.sewing || topology.edge_triangles(edge, 1) == -1) return false;
  const RestSide a = rest_side(mesh, topology, edge, 0), b = rest_side(mesh, topology, edge, 1);
  const Eigen::Vector3d along = a.to - a.from;
  return a.from != b.from || a.to != b.to ||
         along.cross(a.corner - a.from).z() * along.cross(b.corner - a.from).z() > 0;
}

std::vector<int> seam_edges(const TriangleMesh& mesh, const Topology& topology) {
  std::vector<int> seams;
  for (int e = 0; mesh.sewing && e < topology.edges.rows(); ++e)
    if (is_seam(mesh, topology, e)) seams.push_back(e);
  return seams;
}

}  // namespace drape
