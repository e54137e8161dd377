#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/numerics/patterns/generate.h"

/// A turn about none of the coordinates' axes.
inline const Eigen::Matrix3d some_turn =
    Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();

struct NamedMesh {
  std::string name;
  drape::TriangleMesh mesh;
  bool straight;  ///< flat and convex with a border of straight sides, so that no area may be lost
};

/// Rest shapes to refine.
inline std::vector<NamedMesh> meshes_to_refine() {
  using namespace drape;
  TriangleMesh curved = random_triangulation({0.6, 0.5}, 50, 3);
  curved.vertices.col(2) = 0.3 * curved.vertices.col(0).cwiseProduct(curved.vertices.col(1));
  return {{"grid", grid({0.6, 0.5}, 6, 5, Diagonals::one_way), true},
          {"criss-cross", grid({0.6, 0.5}, 6, 5, Diagonals::criss_cross), true},
          {"equilateral", equilateral({0.6, 0.5}, 6, 6), true},
          {"random triangulation", random_triangulation({0.6, 0.5}, 50, 2), true},
          {"disc", disc(0.4, 40), false},
          {"polygon with a hole",
           delaunay_polygon(
               {{{0, 0}, {0.8, 0}, {0.6, 0.6}, {0.1, 0.5}}, {{0.3, 0.2}, {0.5, 0.2}, {0.4, 0.35}}}, 60, 1),
           false},
          {"curved", curved, false}};
}
