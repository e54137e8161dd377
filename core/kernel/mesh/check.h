#pragma once

#include <string>
#include <vector>

#include "core/kernel/mesh/triangle_mesh.h"

namespace drape {

/// The faults that keep a mesh from being a cloth or an obstacle, one line each, naming the element
/// (vertices and triangles count from 0); of many, the first and their number. Empty for a valid mesh.
/// Checked are:
/// - an empty mesh; an index out of range; a vertex without triangle; the coordinates, as in
/// check_coordinates;
/// - a triangle that repeats a vertex, has no area (height below 1e-12 of its longest edge) or occurs twice;
/// - an edge with more than two triangles, or two that run along it in the same direction;
/// - a vertex whose triangles form more than one fan;
/// - in a flat mesh (all z = 0), a triangle that faces the other way than most.
/// Connectivity is checked only if all indices are in range.
std::vector<std::string> check_mesh(const TriangleMesh& mesh);

/// The faults of coordinates [m]: one that is not finite or too large, a mesh without extent, and a mesh so
/// far from the origin that round-off changes its shape.
std::vector<std::string> check_coordinates(const Positions& x);

/// The smallest angle of all triangles [degree]; 0 for a mesh without triangles.
double smallest_angle(const TriangleMesh& mesh);

}  // namespace drape
