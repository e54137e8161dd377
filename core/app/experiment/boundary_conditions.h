#pragma once

#include "core/app/experiment/experiment.h"

namespace drape {

/// The selected vertices of a level, ascending. "nearest" selects the vertex of the coarsest level that is
/// nearest to the point, and on finer levels its child, which has the same index.
std::vector<int> selected_vertices(const VertexSelection& selection, const Level& level,
                                   const Level& coarsest);

/// The pins or the handles, as `part` says.
std::vector<VertexSelection> selections_of(const ExperimentParameters& parameters, LoadPart part);

/// The target [m] of a vertex that a pin or handle selects; without a transform, its position in `placed`
/// (n×3) [m].
Eigen::Vector3d target_of(const VertexSelection& selection, int vertex, const Level& level,
                          const Positions& placed);

/// Appends an error for every pin and handle that selects no vertex of a level, or one that does not exist.
void check_boundary_conditions(const Experiment& experiment, const std::vector<Level>& levels,
                               ConfigErrors& errors);

/// The same for pin or handle k alone, as `part` says, with `where` as the errors' location.
void check_selection(const ExperimentParameters& parameters, LoadPart part, std::size_t k,
                     const Location& where, const std::vector<Level>& levels, ConfigErrors& errors);

/// The Dirichlet vertices of a level with their targets [m]. Of several pins that select a vertex the last
/// one counts; they agree on its target (check_shared_vertices). Throws std::runtime_error naming a pin that
/// selects no vertex.
std::vector<DirichletVertex> dirichlet_vertices(const ExperimentParameters& parameters, const Level& level,
                                                const Level& coarsest, const Positions& placed);

/// The penalty energy of all handles, equally stiff on every level; null without a handle. A handle without a
/// transform pulls to the positions in `placed`, n×3 [m] for each level. Both references must outlive it.
std::shared_ptr<const Energy> handles_energy(const ExperimentParameters& parameters, const Level& coarsest,
                                             const std::vector<Positions>& placed);

}  // namespace drape
