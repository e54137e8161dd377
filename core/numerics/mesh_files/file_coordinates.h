#pragma once

#include <string>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// How the coordinates in a mesh file are meant: their unit, and the axis that points up. Both say how to
/// read the file, before any transform. core/kernel/plugin/placement.h declares them; another word counts as
/// the default.
struct FileCoordinates {
  std::string unit = "m";  ///< "mm", "cm", "m" or "inch"
  std::string up = "z";    ///< "y" or "z"

  /// Converts coordinates of the file to metres with z up.
  void convert(Positions& x) const {
    // A quotient, unlike a product with 0.001, is the double nearest to the length in metres.
    if (unit == "mm")
      x /= 1000;
    else if (unit == "cm")
      x /= 100;
    else if (unit == "inch")
      x *= 0.0254;
    if (up != "y") return;
    // A quarter turn about x, without the rounding of a sine: what is flat stays flat.
    x.col(1).swap(x.col(2));
    x.col(1) = -x.col(1);
  }
  /// The inverse of convert, but for rounding.
  void restore(Positions& x) const {
    x *= unit == "mm" ? 1000 : unit == "cm" ? 100 : unit == "inch" ? 1 / 0.0254 : 1;
    if (up != "y") return;
    x.col(1) = -x.col(1);
    x.col(1).swap(x.col(2));
  }
  bool operator==(const FileCoordinates&) const = default;
};

}  // namespace drape
