#pragma once

#include <limits>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"
#include "core/numerics/collision_detection/box_tree.h"

namespace drape {

/// The point of a surface that is nearest to another point.
struct NearestPoint {
  int triangle = -1;                                  ///< the first of equally near ones; -1: none in reach
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();  ///< of its corners
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();   ///< from there to the other point [m]
};

/// Finds what of a surface is nearest, in a time that hardly grows with the number of its triangles. The mesh
/// must outlive it.
class SurfaceSearch {
 public:
  explicit SurfaceSearch(const TriangleMesh& mesh);
  /// Finds only these triangles of the mesh.
  SurfaceSearch(const TriangleMesh& mesh, std::vector<int> triangles);

  /// The nearest point to p that is nearer than `reach` [m].
  NearestPoint nearest(const Eigen::Vector3d& p,
                       double reach = std::numeric_limits<double>::infinity()) const;
  /// Calls visit(triangle) for each triangle whose bounding box is within `reach` of p [m].
  template <class Visit>
  void visit_near(const Eigen::Vector3d& p, double reach, const Visit& visit) const {
    const Box at = Box::around(p, p, 0);
    tree_.visit_near(
        reach * reach, [&](const Box& box) { return box.squared_distance(at); },
        [&](int i) {
          visit(triangles_[i]);
          return reach * reach;
        });
  }
  /// The shortest vector [m] to a vertex of this surface from the other one; `shortest` if none is shorter.
  Eigen::Vector3d shortest_from(const SurfaceSearch& other, Eigen::Vector3d shortest) const;

 private:
  /// The corners of a triangle, one a column.
  Eigen::Matrix3d corners(int triangle) const;

  const TriangleMesh& mesh_;
  std::vector<int> triangles_;  // of the boxes
  Box bounds_;
  BoxTree tree_;
};

/// The shortest vector [m] to a surface from another, of those that begin or end at a vertex. Where two edges
/// are nearer than that, it is longer than the distance by less than an edge.
Eigen::Vector3d shortest_connection(const SurfaceSearch& to, const SurfaceSearch& from);

}  // namespace drape
