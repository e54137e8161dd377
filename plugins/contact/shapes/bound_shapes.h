#pragma once

#include <memory>
#include <vector>

#include "core/kernel/interfaces/contact_model.h"
#include "core/numerics/contact_forces/barrier_parameters.h"
#include "plugins/contact/shapes/solid.h"

namespace drape::shapes {

/// Contact of a level's cloth with solids. Reported gaps are distances of cloth triangles to solids.
/// README.md describes the barrier's pairs of vertices, edges and triangles.
std::unique_ptr<BoundContact> bind_shapes(const Level& level, const std::vector<Solid>& solids,
                                          const BarrierParameters& barrier, double min_gap_fraction);

}  // namespace drape::shapes
