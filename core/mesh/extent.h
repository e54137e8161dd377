#pragma once

namespace drape {

/// The largest coordinate of a mesh [m]: there doubles still resolve 1e-7 m.
constexpr double largest_coordinate = 1e9;
/// The least diagonal of a mesh's box [m].
constexpr double smallest_diagonal = 1e-9;

}  // namespace drape
