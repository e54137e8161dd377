#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/kernel/interfaces/energy.h"
#include "core/numerics/elements/green_strain.h"

namespace drape {

/// Whether a membrane's energy, of Green strains g11, g22, g12 and the last four numbers of a
/// MaterialTriangle, depends on principal stretches alone, not on their directions: on the first of these
/// triangles, which says it for all if the law does not depend on an element's `size_or_place`, or else on
/// each.
bool is_isotropic(const std::vector<MaterialTriangle>& triangles, bool size_or_place,
                  const std::function<double(const Eigen::Vector3d& strains, const double* place)>& energy);

/// The static `role` of an energy's parameters, or the usual one of its kind.
template <class Parameters>
constexpr EnergyRole role_or(EnergyRole usual) {
  if constexpr (requires { Parameters::role; }) return Parameters::role;
  return usual;
}

/// How an energy is bound to a level.
using BindEnergy = std::function<std::unique_ptr<BoundEnergy>(const Level&)>;

/// Energy::midpoint_factor of an energy that does not depend on where an element is at rest, as its values
/// show on small meshes of two sizes and on those meshes split; none if no factor holds for all, or if none
/// of their states has energy.
std::optional<double> sampled_midpoint_factor(const BindEnergy& bind);

/// Energy::plate_stiffness of a fold's energy, on a grid of right-angled triangles of 1 cm.
double fold_plate_stiffness(const BindEnergy& bind);

}  // namespace drape
