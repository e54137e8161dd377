#pragma once

#include "plugins/energy/formula/formula.h"

namespace drape::formula {

/// The law that the parameters of an energy write. Throws RefusedParameters with every fault and its place.
Law read_law(const Formula::Parameters& p);

}  // namespace drape::formula
