#pragma once

#include <vector>

#include "core/kernel/interfaces/topology.h"
#include "core/numerics/collision_detection/box.h"

namespace drape {

/// Triangles and edges of a surface for contact, and the representative triangle of each vertex and edge
/// (Curtis et al. 2008), through which pairs of triangles yield every pair of primitives once.
struct SurfaceTopology {
  Triangles triangles;
  Triangles triangle_edges;  ///< column k: the edge opposite vertex k
  Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor> edges;
  /// 3 t + k of the representative triangle t: vertex k, or the edge opposite it.
  std::vector<int> vertex_corner, edge_corner;
  /// Bit k of triangle t is set where t represents its vertex k, bit 3 + k where the edge opposite it.
  std::vector<unsigned char> represented;

  SurfaceTopology() = default;
  /// The surface of triangles that are a mesh without vertices of no triangle; `topology` is their own.
  SurfaceTopology(const Triangles& triangles, const Topology& topology);
  /// Appends another surface. Its vertices, edges and triangles follow this one's.
  void append(const SurfaceTopology& other);

  int vertex_count() const { return static_cast<int>(vertex_corner.size()); }
  int triangle_count() const { return static_cast<int>(triangles.rows()); }
  bool represents_vertex(int t, int k) const { return (represented[t] >> k & 1) != 0; }
  bool represents_edge(int t, int k) const { return (represented[t] >> (3 + k) & 1) != 0; }
};

/// A cloth's surface for contact, with areas and lengths at rest.
struct Surface : SurfaceTopology {
  Eigen::VectorXd vertex_area, edge_area;  ///< a third of the adjacent rest areas [m²]
  Eigen::VectorXd triangle_area;           ///< at rest [m²]
  Eigen::VectorXd edge_length_squared;     ///< at rest [m²]

  /// The surface of a mesh without triangles of no area and vertices of no triangle; `topology` is its own.
  static Surface of(const TriangleMesh& rest, const Topology& topology);
};

/// Bounding boxes of a surface's linear motion.
struct SweptBoxes {
  const SurfaceTopology& surface;
  std::vector<Box> vertices, triangles;

  /// `moving` must outlive the boxes.
  explicit SweptBoxes(const SurfaceTopology& moving) : surface(moving) {}
  /// Bounds the motion from x0 to x1 (n×3) [m], inflated by `margin` [m], relative to `origin` [m]: a box has
  /// floats, which are fine near it alone.
  void update(const Positions& x0, const Positions& x1, double margin, const Eigen::RowVector3d& origin);
  /// Bounds edge e.
  Box edge(int e) const {
    Box box = vertices[surface.edges(e, 0)];
    box.include(vertices[surface.edges(e, 1)]);
    return box;
  }
};

}  // namespace drape
