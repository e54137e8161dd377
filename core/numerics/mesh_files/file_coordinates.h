#pragma once

#include <string>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// How the coordinates in a mesh file are meant: their unit, and the axis that points up. Both say how to
/// read the file, before any transform. core/kernel/plugin/placement.h declares them.
struct FileCoordinates {
  std::string unit = "m";  ///< "mm", "cm", "m" or "inch"
  std::string up = "z";    ///< "y" or "z"

  /// Converts coordinates of the file to metres with z up.
  void convert(Positions& x) const;
  bool operator==(const FileCoordinates&) const = default;
};

}  // namespace drape
