#pragma once

#include <string>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// The faults that keep a mesh from being a cloth: a line for each kind, with its number, examples and a
/// remedy (vertices and triangles count from 0). Empty for a valid mesh. Checked are:
/// - an empty mesh; an index out of range, without which nothing more is checked; the coordinates, as in
///   check_coordinates;
/// - the elements and the connectivity of mesh_faults.h;
/// - triangles that are not joined where they meet (unjoined_borders.h);
/// - in a flat mesh, triangles that overlap those around a vertex (flat_overlaps).
std::vector<std::string> check_mesh(const TriangleMesh& mesh);

/// The faults of a sewn cloth's flat pieces: triangles without texture coordinates or without area there, and
/// those that are turned over in their piece. Pieces may overlap, and be mirrored.
std::vector<std::string> check_pieces(const TriangleMesh& mesh);

/// The faults of coordinates [m]: one that is not finite or too large, a mesh without extent, and a mesh so
/// far from the origin that round-off changes its shape.
std::vector<std::string> check_coordinates(const Positions& x);

}  // namespace drape
