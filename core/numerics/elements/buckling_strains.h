#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "core/kernel/interfaces/energy.h"
#include "core/numerics/elements/green_strain.h"

namespace drape {

/// The energy [J] of a triangle by its Green strains g11, g22, g12, with derivatives; `place` is its area and
/// the centroid at rest, as in MaterialTriangle.
using StrainLaw = std::function<Jet<3, double>(const Eigen::Vector3d& strains, const double* place)>;

/// An anisotropic membrane below whose mesh the cloth buckles: Buckling's relaxed energy
/// (core/numerics/elements/buckling_membrane.h) where wrinkles may have any direction,
///
///     (1 - r) min_A [ W(G + A) + s tr A ] + r W(G),   0 ⪯ A,   C + 2 A ⪯ κ² C
///
/// With M = C + 2 A and a covector c₁ of unit length in C⁻¹, C + 2 A = q₂ C + (q₁ - q₂) c₁ c₁ᵀ: the minimum
/// is over q₁ and q₂ in [1, κ²] and the angle of c₁. First derivatives follow from the envelope theorem,
/// second ones by elimination of what no bound holds. Elements are evaluated one by one: isotropic laws have
/// the vectorised Buckling. The law is kept; s [J] as in Buckling. Throws std::runtime_error naming a
/// triangle without area.
std::unique_ptr<BoundEnergy> bind_buckling_strains(const StrainLaw& law,
                                                   const std::vector<MaterialTriangle>& triangles,
                                                   const Level& level, double s);

}  // namespace drape
