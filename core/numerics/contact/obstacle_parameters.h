#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "core/kernel/plugin/placement.h"
#include "core/numerics/contact/contact_parameters.h"

namespace drape {

/// An item of an experiment's `obstacles`, whatever its geometry. A contact model's own struct derives from
/// this one, calls declare_obstacle in its `declare`, and marks the keys by which its items are known with
/// identifies_item.
struct CommonObstacleParameters {
  std::string name;
  std::optional<double> friction;  ///< μ
  Eigen::Vector3d rotate{0, 0, 0}, translate{0, 0, 0};
};

/// Declares its members. Returns the handle of `translate`.
template <class Derived>
ParameterHandle declare_obstacle(Declaration<Derived>& d) {
  d.add("name", &Derived::name,
        "name, for messages and paths; messages call an unnamed obstacle by its kind and number");
  declare_friction(d).description("its own friction coefficient μ; null: the experiment's `friction`");
  return declare_placement(d);
}

/// Declares a contact model's list of obstacles, which the experiment reads.
template <class Derived>
ParameterHandle declare_obstacles(Declaration<Derived>& d) {
  return d.add_sections("obstacles", &Derived::obstacles).from_experiment();
}

}  // namespace drape
