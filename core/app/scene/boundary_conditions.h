#pragma once

#include <map>
#include <tuple>

#include "core/app/scene/scene.h"

namespace drape {

/// Appends an error for every pin and handle that selects no vertex of a level, or one that does not exist,
/// under a load with these parameters. With `only`, checks only the pin or handle that this key changes.
void check_selections(const Experiment& experiment, const ExperimentParameters& load,
                      const std::vector<Level>& levels, ConfigErrors& errors,
                      const ScheduleKey* only = nullptr);

/// A vertex of a level that two pins, or two handles, want at different places [m].
struct Conflict {
  int level, vertex;
  Eigen::Vector3d target, other_target;
};

/// The first conflict of each two pins, and of each two handles, by whether they are handles and their
/// indices, the later one's first. Without conflicts beyond some 40, which nobody reads.
using Conflicts = std::map<std::tuple<bool, std::size_t, std::size_t>, Conflict>;

/// The conflicts under a load with these parameters. `placed` has the positions, n×3 [m] for each level,
/// where pins and handles without a transform hold.
Conflicts conflicts_of(const ExperimentParameters& load, const std::vector<Level>& levels,
                       const std::vector<Positions>& placed);

/// Appends an error for every conflict. With `only`, for those of that pin or handle; the messages then give
/// no lines of pins, because the error is about the key.
void report(const Conflicts& conflicts, const Experiment& experiment, const std::vector<Level>& levels,
            ConfigErrors& errors, const ScheduleKey* only = nullptr);

/// The Dirichlet vertices of a level with their targets [m]. Of several pins that select a vertex the last
/// one counts. Throws std::runtime_error naming two pins that want it at different places, or a pin that
/// selects no vertex.
std::vector<DirichletVertex> dirichlet_vertices(const ExperimentParameters& parameters, const Level& level,
                                                const Level& coarsest, const Positions& placed);

/// The penalty energy of all handles, equally stiff on every level; null without a handle. A handle without a
/// transform pulls to the positions in `placed`, n×3 [m] for each level. Both references must outlive it.
std::shared_ptr<const Energy> handles_energy(const ExperimentParameters& parameters, const Level& coarsest,
                                             const std::vector<Positions>& placed);

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

/// Moves the targets of `following`, which `dirichlet` has as under the first load, with the obstacles, those
/// of the same level under another load. Throws std::runtime_error naming the pin and the
/// obstacle if the obstacle has other triangles, or the followed one no area.
void move_targets(const FollowingVertices& following, const std::vector<TriangleMesh>& obstacles,
                  std::vector<DirichletVertex>& dirichlet);

}  // namespace drape
