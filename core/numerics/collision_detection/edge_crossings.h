#pragma once

#include <Eigen/Geometry>

namespace drape {

/// Where an edge of a triangle passes through another triangle, the pierced one.
struct EdgeCrossing {
  int corner = 0;           ///< of the triangle; the edge leads from there to the next one
  double along = 0;         ///< the edge, from that corner [1]
  Eigen::Vector3d weights;  ///< of the pierced triangle's corners
  /// Of the edge relative to the pierced triangle: in which the curve along which the triangles cross grows
  /// shorter. Unit length. Intersection contour minimisation (Volino and Magnenat-Thalmann 2006), of each
  /// pair of triangles on its own.
  Eigen::Vector3d away;
};

/// Calls visit(crossing) for each edge of a triangle through another. Corners are columns [m].
template <class Visit>
void visit_edge_crossings(const Eigen::Matrix3d& triangle, const Eigen::Matrix3d& pierced,
                          const Visit& visit) {
  const auto normal_of = [](const Eigen::Matrix3d& c) -> Eigen::Vector3d {
    return (c.col(1) - c.col(0)).cross(c.col(2) - c.col(0));
  };
  const Eigen::Vector3d normal = normal_of(pierced), own_normal = normal_of(triangle);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d edge = triangle.col((k + 1) % 3) - triangle.col(k);
    EdgeCrossing crossing{k, normal.dot(pierced.col(0) - triangle.col(k)) / normal.dot(edge), {}, {}};
    const Eigen::Matrix3d to = pierced.colwise() - triangle.col(k);
    for (int c = 0; c < 3; ++c)
      crossing.weights[c] = to.col((c + 1) % 3).cross(to.col((c + 2) % 3)).dot(edge) / normal.dot(edge);
    if (!(crossing.along >= 0 && crossing.along <= 1 && crossing.weights.minCoeff() >= 0)) continue;
    Eigen::Vector3d curve = normal.cross(own_normal).normalized();  // from there into the triangle
    if (curve.dot(own_normal.cross(edge)) < 0) curve = -curve;
    crossing.away = (curve - curve.dot(edge) / normal.dot(edge) * normal).normalized();
    visit(crossing);
  }
}

}  // namespace drape
