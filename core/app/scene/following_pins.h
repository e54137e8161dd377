#pragma once

#include "core/app/scene/scene.h"

namespace drape {

// A vertex of a pin that follows an obstacle is attached to the point of the obstacle's surface nearest to
// its target under the first load. It keeps its place in the frame of that point's triangle, which the
// triangle's first edge and normal span: rigid motion keeps every distance, and where the obstacle deforms,
// the point stays at its barycentric coordinates and the vertex at its distance from it.

/// Appends an error for every pin of the scene that follows an obstacle which does not exist, has no surface,
/// lacks a vertex that `follow` names, or is farther away than the cloth is large, and for every vertex that
/// another pin wants elsewhere. Returns the attached vertices of each level; the scene needs its levels and
/// models.
std::vector<FollowingVertices> following_vertices(const Experiment& experiment, const Scene& scene,
                                                  ConfigErrors& errors);

/// Moves the targets of `following`, which `dirichlet` has as under the first load, with the obstacles of
/// `contacts`, those of the same level under another load. Throws std::runtime_error naming the pin and the
/// obstacle if the obstacle has other triangles, or the followed one no area.
void move_targets(const FollowingVertices& following, const BoundContacts& contacts,
                  std::vector<DirichletVertex>& dirichlet);

}  // namespace drape
