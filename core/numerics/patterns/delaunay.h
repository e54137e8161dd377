#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <vector>

#include "core/numerics/patterns/generate.h"

namespace drape {

/// Triangles from their smallest vertices on, sorted: an order that depends on them only.
Triangles in_order(std::vector<std::array<int, 3>> triangles);

/// The Delaunay triangulation of distinct points in the plane, counter-clockwise, in an order that depends
/// on the points alone.
Triangles delaunay_triangulation(const std::vector<Eigen::Vector2d>& points);

/// The corners of closed loops, one loop after another; side i begins at corner i.
struct LoopSides {
  std::vector<Eigen::Vector2d> points;
  std::vector<std::array<int, 2>> sides;  ///< the two corners of each
  std::vector<int> loop;                  ///< of each
};
LoopSides sides_of(const std::vector<Polygon>& loops);

/// Signed, positive where the loop runs counter-clockwise.
double area_of(const Polygon& loop);

/// Pairs of segments, each of two points, that cross or touch elsewhere than at a common end, at most so
/// many; exact.
std::vector<std::array<int, 2>> crossing_segments(const std::vector<Eigen::Vector2d>& points,
                                                  const std::vector<std::array<int, 2>>& segments,
                                                  std::size_t most = SIZE_MAX);

/// The Delaunay triangulation of distinct points in the plane that is constrained by segments, which enclose
/// a region and do not cross, within that region: holes are left out. Counter-clockwise, in an order that
/// depends on the input alone. Throws std::runtime_error if two points are at one place.
Triangles triangles_within(const std::vector<Eigen::Vector2d>& points,
                           const std::vector<std::array<int, 2>>& segments);

/// Edge length h of a mesh of `vertices` vertices with equilateral triangles: with b = border_length / h
/// boundary vertices there are 2 · vertices − b triangles of area √3/4 h² (Euler's formula, less its
/// constant).
double even_spacing(double area, double border_length, int vertices);

/// A region that is meshed with triangles of even size.
struct OutlineSize {
  double area = 0, border = 0;  ///< [m²], [m]
  static OutlineSize of(const TriangleMesh& mesh);
  /// The inverse of even_spacing: the number of vertices of a mesh with edges of this length.
  double vertices(double edge_length) const;
};

/// Whether a mesh must have about the vertices that are asked for, or may have some times as many where
/// corners and angles need them.
enum class VertexCount { about, at_least_about };
/// Thrown for a number of vertices that no mesh within the loops has.
struct ImpossibleCount : std::runtime_error {
  using std::runtime_error::runtime_error;
};
TriangleMesh delaunay_polygon(const std::vector<Polygon>& loops, int vertices_about, unsigned seed,
                              VertexCount count);

/// A flat mesh whose parts are meshed again within their outlines, with edges of about this length [m]; the
/// mesh is valid (check_mesh), its parts need not lie in one plane. Border vertices that are nearer to each
/// other and at which the border turns by less than 30° are left out. Keeps texture coordinates that are an
/// affine function of the place in each part, and warp that is the same all over it. Throws
/// std::runtime_error naming the part that is not flat to a thousandth of its diagonal, whose triangles face
/// both ways, or that is so narrow that it needs many more vertices.
TriangleMesh mesh_outline(const TriangleMesh& flat, double edge_length, unsigned seed);

/// Random numbers that are equal for every standard library.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }  ///< in [0, 1)

 private:
  std::mt19937_64 engine_;
};

}  // namespace drape
