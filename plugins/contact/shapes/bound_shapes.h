#pragma once

#include <memory>
#include <vector>

#include "core/contact/pair_contacts.h"
#include "plugins/contact/shapes/solid.h"

namespace drape {

/// A level's cloth against solids. Every recorded gap is a cloth triangle's distance to a solid; its barrier
/// is made of vertices, edges and insides of triangles as README.md says.
std::unique_ptr<BoundContact> bind_shapes(const Level& level, const std::vector<Solid>& solids,
                                          const BarrierParameters& barrier, double keep);

}  // namespace drape
