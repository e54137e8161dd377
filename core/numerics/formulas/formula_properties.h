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

/// Energy::midpoint_factor of a fold's energy that is flat at rest and does not depend on its place; none if
/// no factor holds for all angles.
std::optional<double> fold_midpoint_factor(
    const std::function<double(double bend, double length, double h1, double h2)>& energy);

/// Energy::plate_stiffness of a fold's energy, on a grid of right-angled triangles of 1 cm.
double fold_plate_stiffness(const std::function<std::unique_ptr<BoundEnergy>(const Level&)>& bind);

/// Energy::midpoint_factor of an energy that is linear in a vertex's position: 1 for energies at the origin
/// and forces, returned together, in proportion to area and mass.
std::optional<double> load_midpoint_factor(
    const std::function<Eigen::Vector4d(double area, double mass)>& energy_and_gradient);

}  // namespace drape
