#pragma once

namespace drape {

/// The linear interpolant of two numbers or matrices: exactly a at 0 and b at 1.
template <class T>
T interpolate(const T& a, const T& b, double t) {
  return (1 - t) * a + t * b;
}

}  // namespace drape
