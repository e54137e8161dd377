#pragma once

#include "core/kernel/interfaces/level.h"

namespace drape {

/// Two border vertices at one place at rest, and how many border vertices lie on another one.
struct Coincidence {
  int first = -1, second = -1, count = 0;
};

/// The first two border vertices of a level that are less than `tolerance` [m] apart, in the order of
/// vertices; without any, the count is 0.
Coincidence coincident_border(const Level& level, double tolerance);

}  // namespace drape
