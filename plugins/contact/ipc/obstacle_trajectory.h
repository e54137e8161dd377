#pragma once

#include <string>

#include "core/kernel/interfaces/energy.h"
#include "core/numerics/collision_detection/broad_phase.h"
#include "core/numerics/contact/pair_geometry.h"
#include "plugins/contact/ipc/obstacle.h"

namespace drape::ipc {

/// The largest collision-free step of obstacles whose parameters change linearly from `before` to `after`,
/// with the cloth at x. It leaves the minimum gap of core/numerics/collision_detection/nonlinear_ccd.h; the
/// limit names the blocking pair. Throws std::runtime_error naming an obstacle whose triangles changed.
StepLimit max_trajectory_step(const Obstacles& before, const Obstacles& after, const Surface& cloth,
                              const Positions& x, double dhat, BroadPhaseKind broad_phase);

/// "cloth vertex 3 and ball triangle 4–5–6".
std::string name_of(const ContactPair& pair, const Obstacles& obstacles, int cloth_vertices);

}  // namespace drape::ipc
