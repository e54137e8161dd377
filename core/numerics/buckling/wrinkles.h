#pragma once

#include <Eigen/Core>
#include <functional>

#include "core/numerics/elements/jet.h"
#include "core/numerics/linear_algebra/pack.h"

namespace drape {

/// The energy [J] of a pack of triangles by their Green strains g11, g22, g12, with derivatives; `place` is
/// each one's area and centroid at rest, as in MaterialTriangle.
using StrainLaw = std::function<Jet<3, Pack<native_pack_width>>(
    const Eigen::Matrix<Pack<native_pack_width>, 3, 1>& strains, const Pack<native_pack_width>* place)>;

/// The energy of one triangle.
Jet<3, double> energy_of_one(const StrainLaw& law, const Eigen::Vector3d& strains, const double* place);

/// The strains at which stress is -s in all directions; NaN without any. s [J] as in Buckling.
Eigen::Vector3d slack_strains(const StrainLaw& law, const double* place, double s);

/// min_A [ W(G + A) + s tr A ] of one triangle that is not taut, 0 ⪯ A, C + 2 A ⪯ κ² C; with derivatives by
/// G, if they are wanted.
///
/// With M = C + 2 A and a covector c₁ of unit length in C⁻¹, C + 2 A = q₂ C + (q₁ - q₂) c₁ c₁ᵀ: Newton's
/// method in q₁ and q₂ in [1, κ²] and the angle of c₁. First derivatives follow from the envelope theorem,
/// second ones by elimination of what no bound holds.
Jet<3, double> wrinkled(const StrainLaw& law, const Eigen::Vector3d& strains, const double* place, double s,
                        bool derivatives);

}  // namespace drape
