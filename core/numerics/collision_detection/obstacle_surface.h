#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "core/numerics/collision_detection/dihedrals.h"
#include "core/numerics/collision_detection/surface.h"

namespace drape {

/// The triangle meshes that a cloth collides with, as one surface of several bodies.
struct ObstacleSurface {
  Positions vertices;  ///< of all bodies [m]
  Surface surface;
  Dihedrals dihedrals;
  std::vector<int> first_vertex;                       ///< of each body, then the total number
  std::vector<std::optional<double>> body_friction{};  ///< μ of each body that has its own

  int body_of(int vertex) const {
    const auto next = std::upper_bound(first_vertex.begin(), first_vertex.end(), vertex);
    return static_cast<int>(next - first_vertex.begin()) - 1;
  }
  /// μ of a body: its own, or the contact model's.
  double friction_of(int body, double of_model) const { return body_friction[body].value_or(of_model); }
};

}  // namespace drape
