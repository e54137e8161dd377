#pragma once

#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

/// Declares `rotate` and `translate`, the members by which a struct places the cloth or an obstacle: scaled
/// where it has a scale, then rotated about the origin, then translated. Returns the handle of `translate`.
template <class Struct>
ParameterHandle declare_placement(Declaration<Struct>& d) {
  d.add("rotate", &Struct::rotate)
      .unit("degree")
      .at_least(-bounds::largest_angle)
      .at_most(bounds::largest_angle)
      .description("rotation about the x, then y, then z axis, applied before `translate`");
  return d.add("translate", &Struct::translate)
      .unit("m")
      .at_least(-bounds::largest_coordinate)
      .at_most(bounds::largest_coordinate)
      .description("translation, applied last");
}

}  // namespace drape
