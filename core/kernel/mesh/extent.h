#pragma once

namespace drape {

/// The largest coordinate of a mesh [m]. Doubles resolve 1e-7 m at that distance.
constexpr double largest_coordinate = 1e9;
/// The least diagonal of a mesh's bounding box [m].
constexpr double smallest_diagonal = 1e-9;
/// The least height of a triangle over its longest edge: far above round-off, far below any usable triangle.
constexpr double smallest_height = 1e-12;

}  // namespace drape
