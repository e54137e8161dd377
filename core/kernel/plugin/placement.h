#pragma once

#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/declaration.h"

namespace drape {

/// Declares `unit` and `up` of a mesh file that the struct names (numerics/mesh_files/file_coordinates.h).
template <class Struct>
void declare_file_coordinates(Declaration<Struct>& d) {
  d.add("unit", &Struct::unit, "unit of the file's coordinates, which are converted to metres before `scale`")
      .choices({"mm", "cm", "m", "inch"});
  d.add("up", &Struct::up,
        "axis of the file that points up; with y, its (x, y, z) is read as (x, -z, y), before `rotate`")
      .choices({"y", "z"});
}

/// Declares `scale`, one factor on all coordinates of a mesh.
template <class Struct>
auto declare_scale(Declaration<Struct>& d) {
  return d.add("scale", &Struct::scale, "scale factor, applied before `rotate` and `translate`")
      .between(1 / bounds::largest_scale, bounds::largest_scale);
}

/// Declares `rotate`, a rotation about the origin.
template <class Struct>
auto declare_rotate(Declaration<Struct>& d) {
  return d
      .add("rotate", &Struct::rotate, "rotation about the x, then y, then z axis, applied before `translate`")
      .unit("degree")
      .between(-bounds::largest_angle, bounds::largest_angle);
}

/// Declares `rotate` and `translate`, the members by which a struct places the cloth or an obstacle: scaled
/// where it has a scale, then rotated about the origin, then translated. Returns the handle of `translate`.
template <class Struct>
auto declare_placement(Declaration<Struct>& d) {
  declare_rotate(d);
  return d.add("translate", &Struct::translate, "translation, applied last")
      .unit("m")
      .between(-bounds::largest_coordinate, bounds::largest_coordinate);
}

}  // namespace drape
