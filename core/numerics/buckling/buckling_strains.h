#pragma once

#include <memory>
#include <vector>

#include "core/kernel/interfaces/energy.h"
#include "core/numerics/buckling/wrinkles.h"
#include "core/numerics/elements/green_strain.h"

namespace drape {

/// An anisotropic membrane below whose mesh the cloth buckles: Buckling's relaxed energy
/// (core/numerics/buckling/buckling_membrane.h) where wrinkles may have any direction,
///
///     (1 - r) min_A [ W(G + A) + s tr A ] + r W(G),   0 ⪯ A,   C + 2 A ⪯ κ² C
///
/// Wrinkles of one direction are found for a pack of triangles at once (OneDirection), others for each
/// triangle alone (wrinkled). The law is kept; s [J] as in Buckling. Throws std::runtime_error naming a
/// triangle without area.
std::unique_ptr<BoundEnergy> bind_buckling_strains(const StrainLaw& law,
                                                   const std::vector<MaterialTriangle>& triangles,
                                                   const Level& level, double s);

}  // namespace drape
