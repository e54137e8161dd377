#pragma once

#include <string>

#include "core/kernel/interfaces/energy.h"

namespace drape {

/// Where an energy or its force jumps along straight paths of the checked level's vertices: from compression
/// through rest to stretch and shear, and from one bent state to another. The stiffness may jump.
/// Returns a sentence that says what jumps, by how much and where, or nothing. States whose energy is not
/// finite are passed over.
std::string jump_of(const Energy& energy, const Material& material);

}  // namespace drape
