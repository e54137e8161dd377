#pragma once

#include <vector>

#include "core/numerics/sewing/pattern.h"

namespace drape {

/// Where an edge of a panel is divided: lengths along it, its two ends included.
struct EdgeDivision {
  std::vector<double> lengths;  ///< ascending [m]
  std::vector<int> stitches;    ///< of each, the stitch that joins it to another edge's; -1 without one
};

/// The division of every edge, `[panel][edge]`, at about `edge_length`. The two sides of a seam have the same
/// stitches, numbered over the whole pattern, as close as the longer side needs them; a chain of edges is
/// divided where an edge of the other chain ends. Appends the faults of seams that cannot be sewn: an edge
/// that is in two of them, and sides whose lengths differ by more than the seam's ease.
std::vector<std::vector<EdgeDivision>> divide_edges(const Pattern& pattern, double edge_length,
                                                    ConfigErrors& errors);

}  // namespace drape
