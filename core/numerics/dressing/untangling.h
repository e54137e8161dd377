#pragma once

#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// The cloth with its vertices moved until it crosses neither itself nor the obstacles, or as far as some
/// hundreds of steps lead: downhill in the length of the curves along which surfaces cross (Volino and
/// Magnenat-Thalmann 2006). They have no history: the cloth leaves by the nearest way, right or wrong.
TriangleMesh untangled(TriangleMesh cloth, const std::vector<TriangleMesh>& obstacles);

}  // namespace drape
