#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

// Flat cloth patterns in the plane z = 0, triangles counter-clockwise seen from +z, lengths in metres.
// Misuse throws std::runtime_error. Results are deterministic, bit for bit.

enum class Diagonals {
  one_way,     ///< every cell is cut like '/'
  criss_cross  ///< cells are cut like '/' and '\' alternately, as on a chessboard ("union jack")
};

/// A rectangle from (0, 0) to `size` with columns × rows vertices, row by row; vertex (i, j) is i + columns ·
/// j.
TriangleMesh grid(Eigen::Vector2d size, int columns, int rows, Diagonals diagonals);

/// A rectangle from (0, 0) to `size` in `rows` rows of triangles' sides, `columns` vertices in the first and
/// one more in every other, which is shifted by half a side: equilateral triangles where size.y() / (rows -
/// 1) is √3/2 · size.x() / (columns - 1), and halves of them at the sides x = 0 and x = size.x().
TriangleMesh equilateral(const Eigen::Vector2d& size, int columns, int rows);

/// Columns and rows for `equilateral` whose triangles are closest to equilateral. If both given counts are 0,
/// the number of vertices is also close to `vertices`; a positive count stays as it is.
Eigen::Vector2i equilateral_counts(const Eigen::Vector2d& size, int vertices, int columns = 0, int rows = 0);

/// Corners of a closed polygon in order, in either orientation.
using Polygon = std::vector<Eigen::Vector2d>;

/// A polygon, loops[0], with holes, loops[1 …], meshed by Delaunay refinement (CGAL's 2D mesh generator,
/// after Shewchuk). All angles exceed 20° where the polygon's own angles permit. Sides are divided evenly at
/// the inner spacing. The number of vertices is within 15 % of `vertices_about`. Another `seed` gives another
/// mesh.
TriangleMesh delaunay_polygon(const std::vector<Polygon>& loops, int vertices_about, unsigned seed);

/// A disc about the origin: delaunay_polygon of a regular polygon that is inscribed in the circle and has
/// sides of the inner spacing.
TriangleMesh disc(double radius, int vertices_about);

/// A rectangle from (0, 0) to `size` with exactly `vertices` vertices: the Delaunay triangulation of evenly
/// spaced boundary vertices and of inner ones by dart throwing (Poisson disk sampling) with a radius that
/// shrinks until all fit.
TriangleMesh random_triangulation(Eigen::Vector2d size, int vertices, unsigned seed);

// Closed surfaces with outward normals.

/// Edge length 1 m, centred at the origin. Bit k of a vertex's index chooses the sign of its coordinate k.
TriangleMesh unit_box();
/// An icosphere of radius 1 m: a subdivided icosahedron with its vertices on the sphere.
TriangleMesh unit_sphere(int subdivisions);

}  // namespace drape
