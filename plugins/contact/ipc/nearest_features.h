#pragma once

#include <array>
#include <vector>

#include "plugins/contact/ipc/dihedrals.h"
#include "plugins/contact/ipc/obstacle.h"

namespace drape {

/// A vertex of the cloth that may come near a triangle of the obstacles.
struct NearTriangle {
  int vertex, triangle;
};

/// A part of a surface that holds the nearest point of one or more of its triangles, edges and vertices to a
/// point p: the inside of a triangle, the inside of an edge, or a vertex.
struct NearestFeature {
  std::array<int, 3> vertices;  ///< of the obstacles: the triangle's, the edge's, the vertex; then -1
  Eigen::Vector3d weights;      ///< of those, adding up to 1: the nearest point
  Eigen::Vector3d normal;       ///< from there to p, unit length
  Eigen::Vector3d along;        ///< the edge's direction; 0 of others
  double distance;              ///< [m]
  double coefficient;           ///< sum of the coefficients of what is nearest there, never 0
  double friction;              ///< μ

  bool is_face() const { return vertices[2] >= 0; }
};

/// Finds what an operator over triangles, edges and vertices comes to for points near the obstacles' surface:
/// most cells cancel before a barrier is evaluated.
class FeatureSearch {
 public:
  FeatureSearch(const Obstacles& obstacles, const OperatorCoefficients& coefficients, double friction,
                double range)
      : obstacles_(obstacles), coefficients_(coefficients), friction_(friction), range_(range) {}

  /// Appends p's features within range whose coefficient is not 0, of one vertex' entries: all triangles that
  /// may be within range of p.
  void append(const Eigen::Vector3d& p, const NearTriangle* begin, const NearTriangle* end,
              std::vector<NearestFeature>& features);

 private:
  enum class Kind { face, edge, vertex };
  struct Cell {
    Kind kind;
    int number;
    double coefficient;
  };
  void add_triangle(const Eigen::Vector3d& p, int t);
  void add_edge(const Eigen::Vector3d& p, int e);
  void add_vertex(const Eigen::Vector3d& p, int v);
  NearestFeature feature(const Eigen::Vector3d& p, const Cell& cell) const;
  Eigen::Vector3d place(int v) const { return obstacles_.vertices.row(v); }

  const Obstacles& obstacles_;
  const OperatorCoefficients& coefficients_;
  double friction_, range_;
  std::vector<Cell> cells_;
  std::vector<int> near_;  // triangles within range
};

}  // namespace drape
