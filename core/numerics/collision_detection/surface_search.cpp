#include "core/numerics/collision_detection/surface_search.h"

#include <numeric>

#include "core/numerics/collision_detection/closest.h"

namespace drape {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Boxes farther than the nearest point by a factor up to this are looked into: round-off decides no tie.
constexpr double tie = 1 + 1e-9;

std::vector<int> all_triangles(const TriangleMesh& mesh) {
  std::vector<int> all(mesh.triangles.rows());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace

SurfaceSearch::SurfaceSearch(const TriangleMesh& mesh) : SurfaceSearch(mesh, all_triangles(mesh)) {}

SurfaceSearch::SurfaceSearch(const TriangleMesh& mesh, std::vector<int> triangles)
    : mesh_(mesh), triangles_(std::move(triangles)) {
  std::vector<Box> boxes;
  for (const int t : triangles_) {
    const Eigen::Matrix3d c = corners(t);
    boxes.push_back(Box::around(c.rowwise().minCoeff(), c.rowwise().maxCoeff(), 0));
    bounds_.include(boxes.back());
  }
  tree_.build(boxes);
}

Eigen::Matrix3d SurfaceSearch::corners(int triangle) const {
  return mesh_.vertices(mesh_.triangles.row(triangle), Eigen::all).transpose();
}

NearestPoint SurfaceSearch::nearest(const Eigen::Vector3d& p, double reach) const {
  NearestPoint nearest;
  const Box at = Box::around(p, p, 0);
  tree_.visit_near(
      tie * reach * reach, [&](const Box& box) { return box.squared_distance(at); },
      [&](int i) {
        const int t = triangles_[i];
        const Eigen::Matrix3d c = corners(t);
        const Eigen::Vector3d weights = -closest_point_triangle(p, c.col(0), c.col(1), c.col(2)).c.tail<3>(),
                              offset = p - c * weights;
        if (const double distance = offset.norm();
            distance < reach || (distance == reach && t < nearest.triangle))
          reach = distance, nearest = {t, weights, offset};
        return tie * reach * reach;
      });
  return nearest;
}

Eigen::Vector3d SurfaceSearch::shortest_from(const SurfaceSearch& other, Eigen::Vector3d shortest) const {
  tree_.visit_near(
      shortest.squaredNorm(), [&](const Box& box) { return box.squared_distance(other.bounds_); },
      [&](int i) {
        const Eigen::Matrix3d own = corners(triangles_[i]);
        for (const auto& p : own.colwise())
          if (const NearestPoint near = other.nearest(p, shortest.norm()); near.triangle >= 0)
            shortest = near.offset;
        return shortest.squaredNorm();
      });
  return shortest;
}

Eigen::Vector3d shortest_connection(const SurfaceSearch& to, const SurfaceSearch& from) {
  const Eigen::Vector3d there = to.shortest_from(from, Eigen::Vector3d::Constant(infinity));
  return -from.shortest_from(to, -there);
}

}  // namespace drape
