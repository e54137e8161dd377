#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

// The viewer's blocks of bytes, little endian; docs/guide/viewer.md says what each holds.

/// Six float32, lower corner and size of the box, then x, y and z plane by plane as uint16 within it, each
/// the difference from the vertex before modulo 2^16. What is not finite becomes the lower corner.
std::string encode_positions(const Positions& x);

/// Plane by plane, each corner as an int32 difference from the triangle before.
std::string encode_triangles(const Triangles& triangles);

/// Two float32, low and high, then a uint8 a value: 0 … 254 within them, ends included, 255 for NaN.
std::string encode_scalars(const Eigen::VectorXd& values, double low, double high);

/// In zlib's format, which browsers call "deflate".
std::string deflated(std::string_view bytes);

}  // namespace drape
