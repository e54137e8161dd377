#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <random>
#include <vector>

#include "core/numerics/linear_algebra/block_matrix.h"

/// A random symmetric positive semidefinite block matrix: a random 12×12 one for every element.
inline drape::BlockMatrix random_matrix(int vertices, const drape::Stencils& stencils, unsigned seed) {
  using Element = Eigen::Matrix<double, 12, 12>;
  drape::BlockMatrix matrix(drape::BlockPattern::of(vertices, {stencils}));
  const drape::BlockSlots slots(*matrix.pattern, stencils);
  drape::BlockSink sink = slots.sink(matrix);
  std::srand(seed);
  for (int e = 0; e < stencils.rows(); ++e) {
    const Element r = Element::Random(), h = r * r.transpose();
    for (int b = 0; b < 4; ++b)
      for (int a = 0; a <= b; ++a) {
        const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> block = h.block<3, 3>(3 * a, 3 * b);
        sink.add(e, a, b, block.data());
      }
  }
  return matrix;
}

/// Elements along a chain.
inline drape::Stencils chain(int vertices) {
  drape::Stencils stencils(vertices - 3, 4);
  for (int e = 0; e < stencils.rows(); ++e) stencils.row(e) << e + 3, e, e + 1, e + 2;
  return stencils;
}

inline drape::BlockMatrix random_matrix(int vertices, unsigned seed) {
  return random_matrix(vertices, chain(vertices), seed);
}

/// Numbers of vertices in no order, as in a file.
inline std::vector<int> shuffled(int vertices, unsigned seed) {
  std::vector<int> number(vertices);
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), std::mt19937(seed));
  return number;
}

/// The hinges of a square grid of side×side vertices.
inline drape::Stencils shell(int side, const std::vector<int>& number) {
  const auto at = [&](int i, int j) { return number[i * side + j]; };
  std::vector<int> v;
  for (int i = 0; i + 1 < side; ++i)
    for (int j = 0; j + 1 < side; ++j) {
      v.insert(v.end(), {at(i, j), at(i + 1, j + 1), at(i + 1, j), at(i, j + 1)});
      if (j + 2 < side) v.insert(v.end(), {at(i, j + 1), at(i + 1, j + 1), at(i, j), at(i + 1, j + 2)});
      if (i + 2 < side) v.insert(v.end(), {at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 2, j + 1)});
    }
  return Eigen::Map<drape::Stencils>(v.data(), static_cast<Eigen::Index>(v.size()) / 4, 4);
}

inline drape::Stencils shell(int side, unsigned seed) { return shell(side, shuffled(side * side, seed)); }

/// Elements of any four vertices: hardly anything of the factor is zero.
inline drape::Stencils tangle(int vertices, int elements, unsigned seed) {
  std::mt19937 random(seed);
  drape::Stencils stencils(elements, 4);
  for (int e = 0; e < elements; ++e)
    for (int k = 0; k < 4; ++k) {
      const auto taken = [&] { return (stencils.row(e).head(k).array() == stencils(e, k)).any(); };
      do stencils(e, k) = static_cast<int>(random() % vertices);
      while (taken());
    }
  return stencils;
}
