#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "core/kernel/interfaces/element_order.h"
#include "core/kernel/interfaces/triangle_mesh.h"
#include "core/numerics/linear_algebra/block_matrix.h"
#include "core/numerics/linear_algebra/pack.h"
#include "core/numerics/linear_algebra/symmetric_eigen.h"

namespace drape {

/// W elements of k vertices, evaluated together: gathers their vertices and scatters their derivatives.
/// Element functions depend on the k - 1 differences d_i = x_i - x_0.
template <int k, int W>
struct ElementPack {
  using T = Pack<W>;
  using Vector = Eigen::Matrix<T, 3, 1>;

  int vertices[k][W];  ///< offset of their coordinates: 3 times the index
  int first;           ///< position in the order of the element in lane 0
  int active;          ///< lanes in use; the others repeat the last element

  /// Row p of `stencils` is the element at position p of the order.
  ElementPack(const Stencils& stencils, int first_in, int end)
      : first(first_in), active(std::min(W, end - first_in)) {
    for (int lane = 0; lane < W; ++lane)
      for (int v = 0; v < k; ++v) vertices[v][lane] = 3 * stencils(position(lane), v);
  }

  /// Position in the order of a lane's element.
  int position(int lane) const { return first + std::min(lane, active - 1); }

  void gather(const Positions& x, Vector* d) const {
    Vector origin;
    gather_rows(x.data(), vertices[0], origin[0], origin[1], origin[2]);
    for (int v = 1; v < k; ++v) {
      gather_rows(x.data(), vertices[v], d[v - 1][0], d[v - 1][1], d[v - 1][2]);
      d[v - 1] -= origin;
    }
  }

  void scatter(const Vector* by_difference, Positions& g) const {
    Vector all[k];
    all[0] = -by_difference[0];
    for (int v = 1; v < k; ++v) {
      all[v] = by_difference[v - 1];
      if (v > 1) all[0] -= all[v];
    }
    for (int lane = 0; lane < active; ++lane)
      for (int v = 0; v < k; ++v) {
        double* to = g.data() + vertices[v][lane];
        for (int c = 0; c < 3; ++c) to[c] += all[v][c].v[lane];
      }
  }

  // Vertex 0's blocks follow from translation invariance: every block row sums to zero.
  void scatter(const SymmetricMatrix<3 * (k - 1), T>& h, BlockSink& sink) const {
    T blocks[k][k][9];
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) {
        blocks[0][0][3 * r + c] = 0.0;
        for (int b = 1; b < k; ++b) {
          T sum = 0.0;
          for (int a = 1; a < k; ++a) {
            const T entry = h(3 * (a - 1) + r, 3 * (b - 1) + c);
            if (a <= b) blocks[a][b][3 * r + c] = entry;
            sum += entry;
          }
          blocks[0][b][3 * r + c] = -sum;
          blocks[0][0][3 * r + c] += sum;
        }
      }
    for (int lane = 0; lane < active; ++lane)
      for (int b = 0; b < k; ++b)
        for (int a = 0; a <= b; ++a) {
          double one[9];
          for (int i = 0; i < 9; ++i) one[i] = blocks[a][b][i].v[lane];
          sink.add(first + lane, a, b, one);
        }
  }
};

/// The elements, sorted by the order.
inline Stencils in_order(const Stencils& elements, const ElementOrder& order) {
  Stencils sorted(elements.rows(), elements.cols());
  for (Eigen::Index e = 0; e < elements.rows(); ++e) sorted.row(e) = elements.row(order.elements[e]);
  return sorted;
}

}  // namespace drape
