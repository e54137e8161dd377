#pragma once

#include <memory>
#include <vector>

#include "core/kernel/interfaces/prolongation_matrix.h"
#include "core/kernel/interfaces/topology.h"
#include "core/numerics/linear_algebra/block_matrix.h"
#include "core/numerics/multigrid/smoother.h"

namespace drape {

/// Weights between two meshes, a row for each vertex that they give a value.
using Weights = Eigen::SparseMatrix<float, Eigen::RowMajor>;

/// Σ_k w_ik x_k.
inline Float4 weighted_sum(const Weights& w, int i, const std::vector<Float4>& x) {
  Float4 sum = {};
  for (Weights::InnerIterator it(w, i); it; ++it) sum += x[it.col()] * it.value();
  return sum;
}

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
  /// Makes the coarser mesh's matrix Pᵀ A P. Returns the number of multiplications of blocks.
  double make_product(MultigridMesh& coarse);
  /// The matrix by vertices. Keeps its pattern object while the pattern is the same; returns whether it is
  /// not.
  bool copy_to(BlockMatrix& matrix) const;

  std::vector<int> order, position;  ///< order[p] is the vertex at position p
  Weights parents, children;         ///< to and from the next coarser mesh
  SmoothedMatrix matrix;
  std::vector<Float4> x, b, r, old;

 private:
  void set_pattern(const std::shared_ptr<const BlockPattern>& given);
  void set_pattern(AdjacencyList pattern);
  /// Finds which blocks Pᵀ A and Pᵀ A P have.
  void find_product_pattern(MultigridMesh& coarse);

  std::vector<double> values_;  // of the matrix's blocks, row-major, and one of padding
  // The block of a given matrix that each block is, complemented if transposed; of this pattern.
  std::vector<int> source_;
  std::shared_ptr<const BlockPattern> pattern_;
  AdjacencyList half_;  // of Pᵀ A; without rows if the matrix has another pattern by now
};

}  // namespace drape
