#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/element_order.h"
#include "core/kernel/interfaces/triangle_mesh.h"
#include "core/kernel/threads/parallel.h"
#include "core/numerics/linear_algebra/block_matrix.h"
#include "core/numerics/linear_algebra/pack.h"
#include "core/numerics/linear_algebra/symmetric_eigen.h"

namespace drape {

/// W elements of k vertices, evaluated together: gathers their vertices and scatters their derivatives.
/// Element functions depend on the k - 1 differences d_i = x_i - x_0.
template <int k>
struct ElementPack {
  static constexpr int W = native_pack_width;
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
  return elements(order.elements, Eigen::all);
}

/// The elements of an energy in packs of W with their rest numbers, chunk by chunk of an order, and sums over
/// them. Energies that are NaN or -∞ count as +∞.
template <int k, int rest_size>
class PackedElements {
 public:
  static constexpr int W = native_pack_width;
  using T = Pack<W>;
  struct Elements : ElementPack<k> {
    T rest[rest_size];
  };

  /// Vertices m×k of the elements, the rest numbers of each, and an order of the elements.
  template <class Rest>
  PackedElements(const Stencils& elements, const std::vector<Rest>& rest, ElementOrder order)
      : order_(std::move(order)), stencils_(in_order(elements, order_)) {
    for (int c = 0; c < order_.chunks(); ++c) {
      first_pack_.push_back(static_cast<int>(packs_.size()));
      const int end = order_.chunk_start[c + 1];
      for (int first = order_.chunk_start[c]; first < end; first += W) {
        Elements pack{{stencils_, first, end}, {}};
        for (int lane = 0; lane < W; ++lane)
          for (int r = 0; r < rest_size; ++r)
            pack.rest[r].v[lane] = rest[order_.elements[pack.position(lane)]][r];
        packs_.push_back(pack);
      }
    }
    first_pack_.push_back(static_cast<int>(packs_.size()));
  }

  /// In the order, as a BoundEnergy's.
  const Stencils& stencils() const { return stencils_; }
  const Elements& operator[](int pack) const { return packs_[pack]; }

  /// The energy of one chunk, from that of each pack.
  class Sum {
   public:
    void add(T energy, int active) {
      constexpr double infinity = std::numeric_limits<double>::infinity();
      energy = select(energy > -infinity, energy, infinity);
      for (int lane = active; lane < W; ++lane) energy.v[lane] = 0;
      sum_ += energy;
    }
    double total() const {
      double result = 0;
      for (int lane = 0; lane < W; ++lane) result += sum_[lane];
      return result;
    }

   private:
    T sum_ = 0.0;
  };

  /// Σ body(first pack, end) over the chunks, in threads. The body must not write what chunks share.
  template <class Body>
  double sum(const Body& body) const {
    Sums sums;
    parallel_for(order_.chunks(), 1, [&](int begin, int end) {
      for (int c = begin; c < end; ++c) sums[c] = body(first_pack_[c], first_pack_[c + 1]);
    });
    return total(sums);
  }

  /// As sum(), for a body that writes to its elements' vertices.
  template <class Body>
  double sum_scattered(const Body& body) const {
    Sums sums;
    order_.for_each_chunk([&](int c) { sums[c] = body(first_pack_[c], first_pack_[c + 1]); });
    return total(sums);
  }

  /// Calls body(first pack, end) for every chunk; it may write to its elements' vertices.
  template <class Body>
  void for_each_chunk(const Body& body) const {
    order_.for_each_chunk([&](int c) { body(first_pack_[c], first_pack_[c + 1]); });
  }

 private:
  using Sums = std::array<double, ElementOrder::max_chunks>;

  double total(const Sums& sums) const {
    double result = 0;
    for (int c = 0; c < order_.chunks(); ++c) result += sums[c];
    return result;
  }

  ElementOrder order_;
  Stencils stencils_;            // in order_
  std::vector<Elements> packs_;  // chunk by chunk
  std::vector<int> first_pack_;  // chunks + 1
};

}  // namespace drape
