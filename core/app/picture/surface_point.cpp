#include "core/app/picture/surface_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drape {

namespace {

Triangles finite_triangles(const TriangleMesh& mesh) {
  Triangles finite(mesh.triangles.rows(), 3);
  Eigen::Index count = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    bool all = true;
    for (int k = 0; k < 3; ++k) all &= mesh.vertices.row(mesh.triangles(t, k)).allFinite();
    if (all) finite.row(count++) = mesh.triangles.row(t);
  }
  finite.conservativeResize(count, 3);
  return finite;
}

}  // namespace

DrawnSurface::DrawnSurface(const TriangleMesh& mesh, const Eigen::Vector3d& centre, const Positions& normals)
    : x((mesh.vertices.rowwise() - centre.transpose()).cast<float>()),
      normals(normals.cast<float>()),
      triangles(finite_triangles(mesh)) {
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    if (!x.row(i).allFinite()) x.row(i).setZero();
}

SurfacePoint DrawnSurface::point(int triangle, float u, float v, const Ray& ray) const {
  const Eigen::Vector3f weight(1 - u - v, u, v);
  Eigen::Matrix3f corners, n;
  SurfacePoint point;
  for (int k = 0; k < 3; ++k) {
    const int i = triangles(triangle, k);
    corners.col(k) = x.row(i);
    n.col(k) = normals.row(i);
  }
  const Eigen::Vector3f across = (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
  const float twice_area = across.norm();
  point.front = across.dot(ray.direction()) < 0;
  const float side = point.front ? 1 : -1;
  point.face_normal = side / std::max(twice_area, std::numeric_limits<float>::min()) * across;
  point.position = corners * weight;
  point.normal = side * (n * weight);
  const float length = point.normal.norm();
  point.normal = length > 0.01f ? Eigen::Vector3f(point.normal / length) : point.face_normal;
  // Interpolated normals may turn away from the eye near a silhouette: they are bent back.
  const float away = point.normal.dot(ray.direction());
  if (away > -0.02f) point.normal = (point.normal - (away + 0.02f) * ray.direction()).normalized();
  // Flat triangles shadow the smooth surface that their normals suggest, in steps along the shadow's border.
  // Rays therefore start on that surface where it bulges out (J. Hanika, Hacking the Shadow Terminator, Ray
  // Tracing Gems II, 2021).
  point.light_origin = point.position;
  for (int k = 0; k < 3; ++k) {
    const float below = std::min(side * (point.position - corners.col(k)).dot(n.col(k)), 0.0f);
    point.light_origin -= weight[k] * side * below * n.col(k);
    const Eigen::Vector3f across_edge =
        (corners.col((k + 2) % 3) - corners.col((k + 1) % 3)).cross(ray.direction()).normalized();
    point.edge_distance[k] = std::abs(across_edge.dot(corners.col((k + 1) % 3) - point.position));
  }
  return point;
}

}  // namespace drape
