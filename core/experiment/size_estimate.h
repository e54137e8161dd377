#pragma once

#include <vector>

#include "core/experiment/experiment.h"

namespace drape {

/// Columns and rows of vertices of a square's or rectangle's grid: those that are set, and else as many as
/// make about `vertices` even cells.
struct GridSize {
  int columns = 0, rows = 0;
};

/// Throws std::runtime_error where that is far from the vertices asked for, or more than a coarsest level may
/// have.
GridSize grid_size(const ClothParameters& cloth);

/// About how many vertices each level will have, before any is built; only a mesh file is read for it. Empty
/// where the cloth cannot be made: building it says why.
std::vector<double> estimated_vertices(const ExperimentParameters& p);

/// Memory that a run takes at most, about, whose finest level has so many vertices [bytes].
double estimated_memory(double vertices);

std::string memory_text(double bytes);  ///< as "2.3 GB"

/// Refuses levels with more vertices than indices can count and, unless allowed, a run whose memory may
/// exceed this machine's.
enum class LargeMemory { refused, allowed };
void refuse_too_large(const Experiment& e, LargeMemory large, ConfigErrors& errors);

}  // namespace drape
