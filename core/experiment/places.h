#pragma once

#include "core/experiment/experiment.h"

namespace drape {

/// The vertices of a region on a level, ascending. "nearest" is the vertex of the coarsest level that is
/// nearest there, and its children, which have its index, on the finer ones.
std::vector<int> vertices_of(const PlaceParameters& region, const Level& level, const Level& coarsest);

/// Appends what is wrong with pins and handles on the coarsest level: that they take hold of nothing, or of
/// vertices that there are not.
void check_places(const Experiment& experiment, const Level& coarsest, ConfigErrors& errors);

/// The held vertices of a level: each where its last pin has it, or where `start` (n×3) does if that pin does
/// not move it.
std::vector<DirichletVertex> dirichlet_vertices(const ExperimentParameters& parameters, const Level& level,
                                                const Level& coarsest, const Positions& start);

/// The handles as an energy, which pulls as hard on every level; null without a handle. `coarsest` must
/// outlive it.
std::shared_ptr<const Energy> handles_energy(const ExperimentParameters& parameters, const Level& coarsest);

}  // namespace drape
