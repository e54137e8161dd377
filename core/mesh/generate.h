#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace drape {

// Flat cloth patterns in the plane z = 0, all triangles counter-clockwise seen from +z. Lengths in
// metres. Misuse throws std::runtime_error. Every result is the same, bit for bit, from run to run.

enum class Diagonals {
  one_way,     ///< every cell is cut like '/'
  criss_cross  ///< cells are cut like '/' and '\' in turn, as on a chessboard ("union jack")
};

/// A rectangle from (0, 0) to `size` with columns × rows vertices, row by row; vertex (i, j) is i + columns ·
/// j.
TriangleMesh grid(Eigen::Vector2d size, int columns, int rows, Diagonals diagonals);

/// A rectangle from (0, 0) to `size` in `rows` rows of triangles' sides, `columns` vertices in the first and
/// one more in every other, which is shifted by half a side: equilateral triangles where size.y() / (rows -
/// 1) is √3/2 · size.x() / (columns - 1), and halves of them at the sides x = 0 and x = size.x().
TriangleMesh equilateral(const Eigen::Vector2d& size, int columns, int rows);

/// Columns and rows for `equilateral` that come nearest to equilateral triangles and, where both given counts
/// are 0, to `vertices` in all; a count above 0 stays.
Eigen::Vector2i equilateral_counts(const Eigen::Vector2d& size, int vertices, int columns = 0, int rows = 0);

/// Corners of one closed polygon in order, in either direction; the last is joined to the first.
using Polygon = std::vector<Eigen::Vector2d>;

/// A polygon, loops[0], with holes, loops[1 …], meshed by Delaunay refinement with all angles above 20°
/// where the polygon's own angles permit (CGAL's 2D mesh generator, after Shewchuk's Delaunay refinement).
/// Sides are cut evenly to the inner spacing. The number of vertices is within 15 % of `vertices_about`.
/// `seed` places the first inner vertex, on which all others depend: another seed, another mesh.
TriangleMesh delaunay_polygon(const std::vector<Polygon>& loops, int vertices_about, unsigned seed);

/// A disc about the origin, by delaunay_polygon from a regular polygon inscribed in the circle, whose sides
/// match the inner spacing.
TriangleMesh disc(double radius, int vertices_about);

/// A rectangle from (0, 0) to `size` with exactly `vertices` vertices: the Delaunay triangulation of evenly
/// spaced border vertices, the corners among them, and well-spaced random inner ones (darts, thrown at a
/// distance that shrinks until all have found room).
TriangleMesh random_triangulation(Eigen::Vector2d size, int vertices, unsigned seed);

}  // namespace drape
