#pragma once

#include <vector>

#include "core/kernel/interfaces/contact_model.h"

namespace drape {

/// The least norm on free vertices [N] that the forces (n×3) [N] can have once friction is added to them.
/// Each contact's friction is any force in its tangent plane of at most FrictionContact::force (Coulomb's
/// cone): so much can hold a cloth at rest, however it came there.
///
/// The minimum is approached until it is known to be above `enough`, or not; the returned norm is on the same
/// side of it.
double norm_beyond_friction(const std::vector<FrictionContact>& contacts, Positions forces,
                            const std::vector<char>& fixed, double enough);

}  // namespace drape
