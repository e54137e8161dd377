#pragma once

#include <array>
#include <vector>

#include "core/numerics/collision_detection/dihedrals.h"
#include "core/numerics/collision_detection/obstacle_surface.h"

namespace drape {

/// A cloth vertex and an obstacle triangle that may come within d̂.
struct VertexTriangleCandidate {
  int vertex, triangle;
};

/// A feature of the obstacles' surface (interior of a triangle, interior of an edge, or vertex) that contains
/// the point nearest to p of one or more triangles, edges and vertices.
struct NearestFeature {
  std::array<int, 3> vertices;  ///< the feature's obstacle vertices, padded with -1
  Eigen::Vector3d weights;      ///< barycentric coordinates of the nearest point
  Eigen::Vector3d normal;       ///< unit vector from there to p
  Eigen::Vector3d along;        ///< unit direction of an edge; 0 for other features
  double distance;              ///< [m]
  double coefficient;           ///< sum of the coefficients with their nearest point here, never 0
  double friction;              ///< μ
  int body;                     ///< the obstacle

  bool is_face() const { return vertices[2] >= 0; }
};

/// Evaluates the improved maximum operator (Li et al. 2023) for points near the obstacles' surface. Terms
/// with the same nearest feature are added before the barrier is evaluated, and most cancel.
class FeatureSearch {
 public:
  FeatureSearch(const ObstacleSurface& obstacles, const OperatorCoefficients& coefficients, double friction,
                double dhat)
      : obstacles_(obstacles), coefficients_(coefficients), friction_(friction), dhat_(dhat) {}

  /// Appends p's features within d̂ with a non-zero coefficient. [begin, end) are all triangles that may be
  /// within d̂ of p.
  void append(const Eigen::Vector3d& p, const VertexTriangleCandidate* begin,
              const VertexTriangleCandidate* end, std::vector<NearestFeature>& features);

 private:
  enum class Kind { face, edge, vertex };
  struct Term {
    Kind kind;
    int index;
    double coefficient;
  };
  void add_triangle(const Eigen::Vector3d& p, int t);
  void add_edge(const Eigen::Vector3d& p, int e);
  void add_vertex(const Eigen::Vector3d& p, int v);
  NearestFeature feature(const Eigen::Vector3d& p, const Term& term) const;
  Eigen::Vector3d position(int v) const { return obstacles_.vertices.row(v); }

  const ObstacleSurface& obstacles_;
  const OperatorCoefficients& coefficients_;
  double friction_, dhat_;
  std::vector<Term> terms_;
  std::vector<int> near_;  // triangles within d̂
};

}  // namespace drape
