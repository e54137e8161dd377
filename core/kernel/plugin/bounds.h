#pragma once

namespace drape::bounds {

// Bounds that declarations share. Each exceeds any cloth's value by far, and products of a few of them do not
// overflow doubles; coordinates also fit the floats of bounding boxes.

constexpr double smallest_length = 1e-9, largest_length = 1e6;  ///< [m]
constexpr double largest_coordinate = 1e9;                      ///< [m]; doubles resolve 1e-7 m there
constexpr double smallest_diagonal = 1e-9;                      ///< of a mesh's bounding box [m]
/// Height of a triangle over its longest edge: far above round-off, far below any usable triangle.
constexpr double smallest_height = 1e-12;
constexpr double largest_angle = 1e6;        ///< [degree], about 2800 revolutions
constexpr double largest_scale = 1e6;        ///< factor on a mesh's coordinates
constexpr double largest_modulus = 1e13;     ///< [Pa], ten times diamond's
constexpr double largest_load = 1e12;        ///< [N], or per area [Pa]
constexpr double largest_friction = 100;     ///< rubber on rubber has about 4
constexpr double smallest_time_step = 1e-8;  ///< [s]; Newton reduces no step further
constexpr double largest_time_step = 1e9;    ///< [s]
constexpr double most_vertices = 1e7;        ///< of the coarsest level
constexpr double largest_int = 2147483647;

}  // namespace drape::bounds
