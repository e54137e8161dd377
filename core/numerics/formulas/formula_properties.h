#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>

#include "core/kernel/interfaces/energy.h"

namespace drape {

/// Whether a density of Green strains g11, g22, g12 depends on principal stretches alone, not on their
/// directions.
bool is_isotropic(const std::function<double(const Eigen::Vector3d& strains)>& density);

/// Green strains of a triangle with these principal stretches, at an angle in the material's frame.
Eigen::Vector3d green_strains(double s1, double s2, double angle);

/// How an energy is bound to a level.
using BindEnergy = std::function<std::unique_ptr<BoundEnergy>(const Level&)>;

/// Energy::midpoint_factor of an energy that does not depend on where an element is at rest, as its values
/// show on small meshes of two sizes and on those meshes split; none if no factor holds for all.
std::optional<double> sampled_midpoint_factor(const BindEnergy& bind);

/// Energy::plate_stiffness of a fold's energy, on a grid of right-angled triangles of 1 cm.
double fold_plate_stiffness(const BindEnergy& bind);

}  // namespace drape
