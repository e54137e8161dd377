#pragma once

#include <string>
#include <vector>

#include "core/app/experiment/garment_place.h"
#include "core/app/scene/scene.h"
#include "core/numerics/dressing/openings.h"

namespace drape {

/// The body that `dress` names, as a model has it.
TriangleMesh dressed_body(const Experiment& experiment, const LevelModel& model);

/// The openings of a garment at x (n×3) [m]. They have nothing of the pattern's file, which a resumed run
/// does not read.
std::vector<GarmentOpening> garment_openings(const Level& level, const Positions& x,
                                             const TriangleMesh& body);

/// Says through which openings no part of the body passes, as "no part of the body passes through the
/// opening of sleeve_left, by its edge cuff". "" if there is none, and for a garment that hangs on a smaller
/// body, such as a hanger, of which a part passes through one opening.
std::string not_worn_text(const ClothParameters& cloth, const Level& level, const Positions& x,
                          const TriangleMesh& body);

/// The same of a garment that is placed, but not sewn, around a contracted body. As limbs are short there,
/// and cross the garment at their full size, it suffices that a part passes through an opening at either
/// size, or that the full body is within a circle of the border's length around its middle.
std::string not_placed_text(const ClothParameters& cloth, const Level& level, const Positions& x,
                            const TriangleMesh& contracted, const TriangleMesh& full);

/// What to do about it.
inline constexpr const char* remedy_of_not_placed =
    "place the pieces around that part of the body, or turn the part to where they are";

}  // namespace drape
