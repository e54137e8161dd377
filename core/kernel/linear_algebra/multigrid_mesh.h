#pragma once

#include <memory>
#include <vector>

#include "core/kernel/linear_algebra/block_matrix.h"
#include "core/kernel/linear_algebra/prolongation_matrix.h"
#include "core/kernel/linear_algebra/smoother.h"

namespace drape {

/// Sparse weights by row.
struct Weights {
  std::vector<int> start = {0}, columns;
  std::vector<float> values;

  int rows() const { return static_cast<int>(start.size()) - 1; }
  /// With so many rows.
  Weights transposed(int columns_of_all) const;
  /// Σ_k w_ik x_k.
  Float4 sum(int i, const std::vector<Float4>& x) const {
    Float4 s = {};
    for (int k = start[i]; k < start[i + 1]; ++k) s += x[columns[k]] * values[k];
    return s;
  }
};

/// One mesh of Multigrid, with its matrix and the vectors of a cycle. Rows are by position: vertices are
/// sorted by their parents, so that neighbours are near each other in memory.
struct MultigridMesh {
  /// The coarsest mesh.
  explicit MultigridMesh(int vertices);
  /// The mesh that P makes of a coarser one.
  MultigridMesh(const ProlongationMatrix& p, const MultigridMesh& coarse);

  int size() const { return static_cast<int>(order.size()); }

  /// Takes over a given matrix plus diag(shift_i I₃), with identities for fixed vertices (one flag a vertex).
  void fill(const BlockMatrix& given, const Eigen::VectorXd& shift, const std::vector<char>& fixed);
  /// Makes the coarser mesh' matrix Pᵀ A P. Returns the number of multiplications of blocks.
  double make_product(MultigridMesh& coarse) const;
  /// The matrix by vertices. Keeps its pattern object while the pattern is the same; returns whether it is
  /// not.
  bool copy_to(BlockMatrix& matrix) const;

  std::vector<int> order, position;  ///< order[p] is the vertex at position p
  Weights parents, children;         ///< to and from the next coarser mesh
  SmoothedMatrix matrix;
  std::vector<Float4> x, b, r, old;

 private:
  void resize();
  void set_pattern(const std::shared_ptr<const BlockPattern>& given);

  std::vector<double> values_;  // of the matrix' blocks, row-major, and one of padding
  // The block of a given matrix that each block is, complemented if transposed; of this pattern.
  std::vector<int> source_;
  std::shared_ptr<const BlockPattern> pattern_;
};

}  // namespace drape
