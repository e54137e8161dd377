#pragma once

#include <string>

#include "core/kernel/interfaces/energy.h"

namespace drape {

/// Where an energy or its force jumps along straight paths of the level's vertices: from compression through
/// rest to stretch and shear, through states in which both principal stretches are equal and change places,
/// and from one bent state to another. The stiffness may jump. Takes about 10⁴ evaluations.
/// Returns a sentence that says what jumps, by how much and where, and what to do; or nothing. States whose
/// energy is not finite are passed over.
std::string jump_of(const BoundEnergy& energy, const Level& level);
/// Looks for jumps on the level on which derivatives are checked.
std::string jump_of(const Energy& energy, const Material& material);

}  // namespace drape
