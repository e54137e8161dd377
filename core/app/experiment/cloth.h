#pragma once

#include <optional>

#include "core/app/experiment/experiment.h"
#include "core/numerics/patterns/delaunay.h"

namespace drape {

/// The cloth of the coarsest level; empty, with every fault appended, if it is none.
std::optional<TriangleMesh> checked_cloth(const Experiment& experiment, ConfigErrors& errors);

/// The mesh of the start's file; empty, with every fault appended, if it is none.
std::optional<TriangleMesh> start_mesh(const Experiment& experiment, ConfigErrors& errors);

/// Columns and rows of vertices of a square's or rectangle's grid: as set, otherwise about `vertices`
/// vertices with square cells. Throws std::runtime_error if the result is far from the requested vertices or
/// too large for a coarsest level.
Eigen::Vector2i grid_counts(const ClothParameters& cloth);

/// The number of vertices by the edge length. Throws std::runtime_error for more than a coarsest level may
/// have.
int vertices_within(const OutlineSize& outline, double edge_length);

/// Estimated vertices of each level. Builds no level, but reads a cloth's file, and meshes a sewing pattern
/// to count its vertices unless they are given, or too many for this machine by the panels' outlines. Empty
/// if the cloth cannot be made, which checked_cloth reports.
std::vector<double> estimated_vertices(const ExperimentParameters& p, std::optional<double> of_pattern = {});

/// Estimated peak memory of a run whose finest level has `vertices` vertices [bytes].
double estimated_memory(double vertices);

/// "2.3 GB".
std::string memory_text(double bytes);

/// Appends an error for levels with more vertices than indices can count and, unless allowed, for a run that
/// may need more memory than this machine has.
void refuse_too_large(const Experiment& e, LargeMemory large, ConfigErrors& errors,
                      std::optional<double> of_pattern = {});

}  // namespace drape
