#pragma once

#include <array>
#include <memory>
#include <string>

#include "core/kernel/interfaces/energy.h"
#include "core/numerics/contact/pair_geometry.h"
#include "plugins/contact/ipc/obstacle.h"

namespace drape::ipc {

struct ClothSearch;
struct ObstacleTree;

/// The largest collision-free step of obstacles whose parameters change linearly from `before` to `after`,
/// with the cloth at x. It leaves the minimum gap of core/numerics/collision_detection/nonlinear_ccd.h; the
/// limit names the blocking pair. The caller holds search.busy. Throws std::runtime_error naming an
/// obstacle whose triangles changed.
StepLimit max_trajectory_step(const ObstacleTree& before, const std::shared_ptr<const Obstacles>& after,
                              ClothSearch& search, const Positions& x, double dhat);

/// "cloth vertex 3 and ball triangle 4–5–6".
std::string name_of(const std::array<int, 4>& vertices, PairKind kind, const Obstacles& obstacles,
                    int cloth_vertices);

}  // namespace drape::ipc
