#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/declaration.h"
#include "core/kernel/plugin/placement.h"
#include "core/numerics/contact_forces/barrier.h"
#include "core/numerics/contact_forces/contact_stiffness.h"

namespace drape {

/// Parameters of every contact model with a barrier. A model's own struct derives from this one and calls
/// declare_contact_parameters in its `declare`.
struct ContactParameters {
  double friction = 0;                        ///< μ
  double dhat = 1e-3;                         ///< d̂
  std::optional<double> stiffness;            ///< κ
  double friction_smoothing_distance = 1e-4;  ///< ε_v h
  double min_gap_fraction = 0.1;

  /// With the default stiffness for this material where none is given.
  BarrierParameters barrier(const Material& material) const {
    return {dhat, stiffness.value_or(contact_stiffness(material)), friction_smoothing_distance,
            stiffness.has_value()};
  }
};

/// Declares `friction`: of an experiment, of a contact model, which takes the experiment's, or of an
/// obstacle.
template <class Struct>
auto declare_friction(Declaration<Struct>& d) {
  return d
      .add("friction", &Struct::friction,
           "Coulomb's friction coefficient μ, where an obstacle does not have its own")
      .between(0, bounds::largest_friction)
      .source("Li et al. 2020, section 5");
}

template <class Derived>
void declare_contact_parameters(Declaration<Derived>& d) {
  declare_friction(d).from_experiment();
  d.add("dhat", &Derived::dhat, "barrier activation distance d̂: the barrier acts on smaller gaps")
      .unit("m")
      .between(bounds::smallest_length, 1e3)
      .source("Li et al. 2020, eq. 6");
  d.add("stiffness", &Derived::stiffness,
        "barrier stiffness κ: the barrier's pressure is κ |b'(gap / d̂)|; null: ten times the cloth's "
        "weight per area or the loads' pressure, raised where contacts carry far more")
      .unit("Pa")
      .between(1e-9, bounds::largest_modulus)
      .source("core/numerics/contact_forces/contact_stiffness.h");
  d.add("friction_smoothing_distance", &Derived::friction_smoothing_distance,
        "ε_v h: friction is smoothed at smaller tangential displacements, where a contact sticks")
      .unit("m")
      .between(1e-12, 1e3)
      .source("Li et al. 2020, eq. 14");
  d.add("min_gap_fraction", &Derived::min_gap_fraction,
        "fraction of every gap that a step must leave: s of additive CCD")
      .between(1e-6, 0.99)
      .source("Li et al. 2021");
}

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
auto declare_obstacle(Declaration<Derived>& d) {
  d.add("name", &Derived::name,
        "name, for messages and paths; messages call an unnamed obstacle by its kind and number");
  declare_friction(d).description("its own friction coefficient μ; null: the experiment's `friction`");
  return declare_placement(d);
}

/// Declares a contact model's list of obstacles, which the experiment reads.
template <class Derived>
auto declare_obstacles(Declaration<Derived>& d) {
  return d.add_sections("obstacles", &Derived::obstacles).from_experiment();
}

}  // namespace drape
