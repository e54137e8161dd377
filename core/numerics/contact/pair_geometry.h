#pragma once

#include <array>
#include <vector>

#include "core/kernel/interfaces/level.h"
#include "core/numerics/collision_detection/closest.h"

namespace drape {

/// Point 0 against triangle 1 … 3, or edge (0, 1) against edge (2, 3). edge_end is point 0, the end of edge
/// (0, 1), against edge (2, 3).
enum class PairKind : char { point_triangle, edge_edge, edge_end };

/// A pair of primitives. Indices count the cloth's n vertices, then the obstacles'.
struct ContactPair {
  std::array<int, 4> vertices;
  PairKind kind = PairKind::point_triangle;
  int obstacle = -1;          ///< index in the contact model; -1 for two primitives of the cloth
  double weight = 0;          ///< area weight of the pair's energy [m²]
  double dhat = 0;            ///< d̂ of the pair, below which its barrier acts [m]
  double offset = 0;          ///< a rounded obstacle's radius: gap = distance - offset [m]
  double mollifier = 0;       ///< edge_edge, edge_end: ε of the mollifier, |u × v|² [m⁴]
  double friction = 0;        ///< μ
  bool at_rim = false;        ///< a cloth edge at a sharp edge of an obstacle (RimContact)
  int surface_triangle = -1;  ///< of a cloth vertex and an obstacle triangle: this triangle; else -1
};

/// The linear motion of the cloth from x0 to x1 and of the obstacles' vertices, searched for pairs within d̂.
struct LinearMotion {
  const Positions& x0;
  const Positions& x1;
  double dhat;  ///< d̂ [m]
  const Positions &obstacles0, &obstacles1;
};

/// The positions of a pair's vertices, as columns [m].
using PairPositions = Eigen::Matrix<double, 3, 4>;

template <class Pair>
PairPositions positions_of(const Pair& pair, const Positions& x, const Positions& obstacles) {
  const int n = static_cast<int>(x.rows());
  PairPositions result;
  for (int k = 0; k < 4; ++k) {
    const int v = pair.vertices[k];
    result.col(k) = v < n ? x.row(v) : obstacles.row(v - n);
  }
  return result;
}

inline Closest closest(PairKind kind, const PairPositions& x) {
  const Eigen::Vector3d x0 = x.col(0), x1 = x.col(1), x2 = x.col(2), x3 = x.col(3);
  if (kind == PairKind::edge_edge) return closest_edge_edge(x0, x1, x2, x3);
  if (kind == PairKind::edge_end) return closest_edge_end(x0, x2, x3);
  return closest_point_triangle(x0, x1, x2, x3);
}

/// Whether the vertices of a pair are two edges.
inline bool has_two_edges(PairKind kind) { return kind == PairKind::edge_edge || kind == PairKind::edge_end; }

/// The number of vertices of a pair's first primitive.
inline int first_primitive_size(PairKind kind) { return has_two_edges(kind) ? 2 : 1; }

/// The distance of the two primitives' bounding boxes, a lower bound of theirs [m].
inline double box_distance(PairKind kind, const PairPositions& x) {
  Eigen::Vector3d low_a = x.col(0), high_a = low_a, low_b = x.col(3), high_b = low_b;
  const Eigen::Vector3d x1 = x.col(1), x2 = x.col(2);
  Eigen::Vector3d& low = has_two_edges(kind) ? low_a : low_b;
  Eigen::Vector3d& high = has_two_edges(kind) ? high_a : high_b;
  low = low.cwiseMin(x1);
  high = high.cwiseMax(x1);
  low_b = low_b.cwiseMin(x2);
  high_b = high_b.cwiseMax(x2);
  return (low_b - high_a).cwiseMax(low_a - high_b).cwiseMax(0).norm();
}

/// r = Σ c_k x_k, computed relative to vertex 0.
inline Eigen::Vector3d connection(const PairPositions& x, const Closest& closest) {
  Eigen::Vector3d r = Eigen::Vector3d::Zero();
  for (int k = 1; k < 4; ++k) r += closest.c[k] * (x.col(k) - x.col(0));
  return r;
}

/// Whether the pair's gap at x is below its d̂.
inline bool is_within_dhat(const ContactPair& pair, const PairPositions& x) {
  const double reach = pair.offset + pair.dhat;
  return box_distance(pair.kind, x) < reach &&
         connection(x, closest(pair.kind, x)).squaredNorm() < reach * reach;
}

/// r / |r|, orthogonalised against the free directions: r itself has few significant digits if the gap is
/// small compared with the primitives.
inline Eigen::Vector3d separating_direction(const PairPositions& x, const Closest& closest) {
  Eigen::Vector3d n = connection(x, closest).normalized();
  Eigen::Vector3d along[2];
  for (int m = 0; m < closest.free; ++m) {
    along[m] = (x * closest.direction.col(m)).eval();
    if (m == 1) along[1] -= along[0].dot(along[1]) / along[0].squaredNorm() * along[0];
    n -= along[m].dot(n) / along[m].squaredNorm() * along[m];
  }
  return n.normalized();
}

}  // namespace drape
