#pragma once

#include <vector>

#include "core/contact/pair_contacts.h"
#include "plugins/contact/shapes/features.h"
#include "plugins/contact/shapes/separation.h"
#include "plugins/contact/shapes/vertex_contacts.h"

namespace drape {

/// What does not change while the cloth of one level moves among its solids. Immutable.
struct ShapeScene {
  Triangles triangles, triangle_edges;                           ///< m×3
  Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor> edges;  ///< e×2
  Eigen::VectorXd vertex_area, edge_area, triangle_area;         ///< of the rest shape [m²]
  Eigen::VectorXd edge_length;                                   ///< of the rest shape [m]
  double diagonal = 0;                                           ///< of the rest shape's box [m]

  std::vector<Solid> solids;
  std::vector<Features> features;  ///< of each solid
  std::vector<int> first_point;    ///< of each solid's features in obstacle_points
  Positions obstacle_points;
  std::vector<int> solid_of_point;
  BarrierParameters barrier;
  double keep = 0.1;

  static ShapeScene of(const Level& level, const std::vector<Solid>& solids, const BarrierParameters& barrier,
                       double keep);

  Corners corners(int triangle, const Positions& x) const {
    return {x.row(triangles(triangle, 0)), x.row(triangles(triangle, 1)), x.row(triangles(triangle, 2))};
  }
};

/// A triangle of the cloth and a solid.
struct TriangleSolidPair {
  int triangle, solid;
};

/// Triangles that may come within range of a solid on the straight way from x0 to x1, solid by solid.
std::vector<TriangleSolidPair> find_triangles(const ShapeScene& scene, const Positions& x0,
                                              const Positions& x1);

/// All contacts that may be within range between two states.
struct ShapeCandidates {
  std::vector<VertexPair> vertices;
  std::vector<ContactPair> pairs;
};

/// Those of the triangles on the straight way from x0 to x1.
ShapeCandidates find_candidates(const ShapeScene& scene, const std::vector<TriangleSolidPair>& triangles,
                                const Positions& x0, const Positions& x1);

}  // namespace drape
