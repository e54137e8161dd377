#pragma once

#include <string>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// Rounding of coordinates may be this part of what they have to resolve: a mesh, a triangle's height.
constexpr double largest_rounding = 1e-6;

/// An edge from a vertex to one of larger index, with its triangles.
struct FaultyEdge {
  int smaller, larger;
  std::vector<int> triangles;  ///< ascending
  bool one_sided = false;      ///< of a surface whose triangles cannot all have the same front side
};

/// The elements of a mesh that a sheet with one side up does not have, ascending. Its indices are in range.
struct MeshFaults {
  struct Pair {
    int element, other;
  };
  std::vector<int> loose_vertices;         ///< of no triangle
  std::vector<int> repeating_triangles;    ///< with a vertex twice
  std::vector<int> empty_triangles;        ///< no area: height below 1e-12 of the longest edge
  std::vector<int> low_triangles;          ///< rounding exceeds largest_rounding of their height
  std::vector<Pair> doubled_triangles;     ///< with the vertices of another triangle, the first of that kind
  std::vector<FaultyEdge> crowded_edges;   ///< more than two triangles
  std::vector<FaultyEdge> inverted_edges;  ///< two triangles that run along it in the same direction
  std::vector<Pair> shared_vertices;  ///< joins fans of triangles that share no edge there, and their number

  /// Finds all but the last three kinds.
  static MeshFaults of_elements(const TriangleMesh& mesh);
  /// Finds the last three kinds. Triangles with `ignored` are left out; none may repeat a vertex otherwise.
  void find_connectivity(const Triangles& triangles, int vertex_count, const std::vector<char>& ignored);
};

/// Says which vertex has more triangles than can be computed with, "" if none has: pairs of triangles at a
/// vertex are many, and CGAL goes through all of them.
std::string crowded_vertex(const Triangles& triangles, int vertex_count);

/// The sides of triangles that no other triangle shares, as half-edge numbers, ascending.
std::vector<int> border_half_edges(const Triangles& triangles, int vertex_count);

/// Triangles of a flat mesh (all z = 0) that face the other way than the rest around an inner vertex and
/// overlap it, ascending: the angles of the triangles at that vertex, negative for those that face down, add
/// up to a full turn. In a mesh that is folded flat, as a cushion, they add up to 0. The mesh must have one
/// or two triangles at every edge, with the same front side. Empty for a mesh that is not flat.
std::vector<int> flat_overlaps(const TriangleMesh& mesh);

}  // namespace drape
