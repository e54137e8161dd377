#pragma once

#include <random>
#include <vector>

#include "core/numerics/patterns/generate.h"

namespace drape {

/// The Delaunay triangulation of distinct points in the plane, counter-clockwise, in an order that depends
/// on the points alone.
Triangles delaunay_triangulation(const std::vector<Eigen::Vector2d>& points);

/// Edge length h of a mesh of `vertices` vertices with equilateral triangles: with b = border_length / h
/// boundary vertices there are 2 · vertices − b triangles of area √3/4 h² (Euler's formula, less its
/// constant).
double even_spacing(double area, double border_length, int vertices);

/// Random numbers that are equal for every standard library.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }  ///< in [0, 1)

 private:
  std::mt19937_64 engine_;
};

}  // namespace drape
