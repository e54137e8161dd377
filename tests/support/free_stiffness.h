#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "core/kernel/interfaces/level.h"
#include "core/numerics/linear_algebra/block_matrix.h"

/// A number for each vertex of a level that is free, in their order, and -1 for the others.
struct FreeVertices {
  std::vector<int> number;
  int count = 0;

  /// All but those for whose place held(p) holds.
  template <class Held>
  FreeVertices(const drape::Level& level, const Held& held) : number(level.vertex_count(), -1) {
    for (int v = 0; v < level.vertex_count(); ++v)
      if (!held(Eigen::Vector2d(level.rest.vertices.row(v).head<2>().transpose()))) number[v] = count++;
  }

  /// Calls visit(v, number) for each of them.
  template <class Visit>
  void each(const Visit& visit) const {
    for (int v = 0; v < static_cast<int>(number.size()); ++v)
      if (number[v] >= 0) visit(v, number[v]);
  }
};

/// Stiffness by displacements of the free vertices along these axes.
inline Eigen::SparseMatrix<double> stiffness_of(const drape::BlockMatrix& h, const FreeVertices& free,
                                                const std::vector<int>& axes) {
  const int n = static_cast<int>(axes.size());
  std::vector<Eigen::Triplet<double>> entries;
  h.pattern->for_each_block([&](int i, int j, int b) {
    const int row = free.number[i], column = free.number[j];
    if (row < 0 || column < 0) return;
    for (int p = 0; p < n; ++p)
      for (int q = 0; q < n; ++q) {
        const double value = h.block(b)[3 * axes[p] + axes[q]];
        entries.emplace_back(n * row + p, n * column + q, value);
        if (i != j) entries.emplace_back(n * column + q, n * row + p, value);
      }
  });
  Eigen::SparseMatrix<double> k(n * free.count, n * free.count);
  k.setFromTriplets(entries.begin(), entries.end());
  return k;
}
