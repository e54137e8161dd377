#pragma once

#include "core/kernel/interfaces/topology.h"

namespace drape {

/// A side of a triangle at rest, and its corner opposite, in the triangle's own plane [m].
struct RestSide {
  Eigen::Vector3d from, to, corner;
};

/// An edge in its first (side 0) or second triangle (1), there in the direction that it has in the first.
RestSide rest_side(const TriangleMesh& mesh, const Topology& topology, int edge, int side);

/// The length of an edge at rest: the mean of its two, which differ at an eased seam [m].
double rest_length(const TriangleMesh& mesh, const Topology& topology, int edge);

/// Whether an edge joins flat pieces: its triangles have other texture coordinates there, or lie on the same
/// side of it, as those of a cushion's two halves may that share their texture coordinates.
bool is_seam(const TriangleMesh& mesh, const Topology& topology, int edge);

/// The edges that are seams of a cloth of flat pieces; none of another cloth.
std::vector<int> seam_edges(const TriangleMesh& mesh, const Topology& topology);

}  // namespace drape
