#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "core/kernel/elements/element_pack.h"
#include "core/kernel/elements/project_hessian.h"
#include "core/kernel/linear_algebra/pack.h"
#include "core/kernel/linear_algebra/parallel.h"
#include "core/kernel/model/element_order.h"
#include "core/kernel/model/energy.h"

namespace drape {

/// A kernel's projected Hessian at the differences d. The projection acts on the whole, or on each of the
/// kernel's independent parts.
template <class Kernel, int Size, class T>
void projected_hessian(const Eigen::Matrix<T, 3, 1>* d, const T* rest, Projection projection,
                       SymmetricMatrix<Size, T>& h) {
  Eigen::Matrix<T, Size, Size> full;
  const auto project_part = [&](auto& part) {
    constexpr int n = std::decay_t<decltype(part)>::RowsAtCompileTime;
    if (projection.is_exact()) return;
    SymmetricMatrix<n, T> m(part);
    if (positive_semidefinite(m)) return;
    projection_detail::project_eigenvalues(m, projection);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i <= j; ++i) part(i, j) = m(i, j);
  };
  if constexpr (requires { Kernel::hessian(d, rest, full, project_part); }) {
    Kernel::hessian(d, rest, full, project_part);
    h = SymmetricMatrix<Size, T>(full);
  } else {
    Kernel::hessian(d, rest, full);
    h = SymmetricMatrix<Size, T>(full);
    if constexpr (!Kernel::convex) project_hessian(h, projection);
  }
}

/// Sum of one kernel over many elements. Gathering, threading, projection and scattering live here for all
/// kernels.
///
/// A Kernel has `vertices` (k), `convex` (no projection needed), `Rest` (a fixed-size vector of doubles) and,
/// for T double or Pack, of the k - 1 differences d_i = x_i - x_0 and the element's rest numbers,
///
///     T value(const Vector3<T>* d, const T* rest);
///     T gradient(const Vector3<T>* d, const T* rest, Vector3<T>* g);      // by d_i; returns the value
///     void hessian(const Vector3<T>* d, const T* rest, Matrix<T>& h);     // upper 3×3 blocks
///
/// A kernel whose Hessian decouples into independent parts in suitable coordinates may also have
///
///     void hessian(const Vector3<T>* d, const T* rest, Matrix<T>& h, const Map& map);
///
/// which calls map(part) on each small symmetric part (upper triangle) and assembles the results. The
/// projection then acts in those coordinates and is much cheaper.
///
/// NaN values count as +∞.
template <class Kernel, int W = native_pack_width>
class ElementEnergy final : public BoundEnergy {
 public:
  /// Vertices m×k of the elements, their rest data, and an order of the elements.
  ElementEnergy(const Stencils& elements, const std::vector<typename Kernel::Rest>& rest, ElementOrder order)
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

  // A pack stays in registers only if everything is inlined, the kernel included: hence `flatten`.
  double value(const Positions& x) const override {
    Sums sums;
    parallel_for(order_.chunks(), 1, [&](int begin, int end) {
      for (int c = begin; c < end; ++c)
        sums[c] = sum_of_chunk(
            c, [&](const Elements& pack) __attribute__((flatten)) {
              Vector d[k - 1];
              pack.gather(x, d);
              return Kernel::value(d, pack.rest);
            });
    });
    return total(sums);
  }

  double add_gradient(const Positions& x, Positions& g) const override {
    Sums sums;
    order_.for_each_chunk([&](int c) {
      sums[c] = sum_of_chunk(
          c, [&](const Elements& pack) __attribute__((flatten)) {
            Vector d[k - 1], by_difference[k - 1];
            pack.gather(x, d);
            const T energy = Kernel::gradient(d, pack.rest, by_difference);
            pack.scatter(by_difference, g);
            return energy;
          });
    });
    return total(sums);
  }

  Stencils stencils() const override { return stencils_; }

  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override {
    order_.for_each_chunk([&](int c) {
      for (int p = first_pack_[c]; p < first_pack_[c + 1]; ++p) {
        Vector d[k - 1];
        Hessian h;
        packs_[p].gather(x, d);
        projected_hessian<Kernel>(d, packs_[p].rest, projection, h);
        packs_[p].scatter(h, sink);
      }
    });
  }

 private:
  static constexpr int k = Kernel::vertices, rest_size = Kernel::Rest::SizeAtCompileTime;
  using T = Pack<W>;
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Hessian = SymmetricMatrix<3 * (k - 1), T>;
  using Sums = std::array<double, ElementOrder::max_chunks>;

  struct Elements : ElementPack<k, W> {
    T rest[rest_size];
  };

  template <class Body>
  double sum_of_chunk(int chunk, const Body& body) const {
    T sum = 0.0;
    for (int p = first_pack_[chunk]; p < first_pack_[chunk + 1]; ++p) {
      T energy = body(packs_[p]);
      energy = select(energy == energy, energy, std::numeric_limits<double>::infinity());
      for (int lane = packs_[p].active; lane < W; ++lane) energy.v[lane] = 0;
      sum += energy;
    }
    double result = 0;
    for (int lane = 0; lane < W; ++lane) result += sum[lane];
    return result;
  }

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
