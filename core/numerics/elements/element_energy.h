#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/energy.h"
#include "core/numerics/elements/packed_elements.h"
#include "core/numerics/elements/project_hessian.h"
#include "core/numerics/linear_algebra/pack.h"

namespace drape {

/// A kernel's projected Hessian at the differences d. The projection acts on the whole, or on each of the
/// kernel's independent parts.
template <class Kernel, int Size, class T>
void projected_hessian(const Kernel& kernel, const Eigen::Matrix<T, 3, 1>* d, const T* rest,
                       Projection projection, SymmetricMatrix<Size, T>& h) {
  Eigen::Matrix<T, Size, Size> full;
  const auto project = [&](auto& part) { project_part(part, projection); };
  if constexpr (requires { kernel.hessian(d, rest, full, project); }) {
    kernel.hessian(d, rest, full, project);
    h = SymmetricMatrix<Size, T>(full);
  } else {
    kernel.hessian(d, rest, full);
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
/// All are static, or const members of a kernel that holds numbers which all elements share. NaN values count
/// as +∞.
template <class Kernel>
class ElementEnergy : public BoundEnergy {
 public:
  /// Vertices m×k of the elements, their rest data, and an order of the elements.
  ElementEnergy(const Stencils& elements, const std::vector<typename Kernel::Rest>& rest, ElementOrder order,
                Kernel kernel = {})
      : packs_(elements, rest, std::move(order)), kernel_(std::move(kernel)) {}

  // A pack stays in registers only if everything is inlined, the kernel included: hence `flatten`.
  double value(const Positions& x) const override {
    return packs_.sum([&](int first, int end) {
      return sum_of_chunk(
          first, end, [&](const Elements& pack) __attribute__((flatten)) {
            Vector d[k - 1];
            pack.gather(x, d);
            return kernel_.value(d, pack.rest);
          });
    });
  }

  double add_gradient(const Positions& x, Positions& g) const override {
    return packs_.sum_scattered([&](int first, int end) {
      return sum_of_chunk(
          first, end, [&](const Elements& pack) __attribute__((flatten)) {
            Vector d[k - 1], by_difference[k - 1];
            pack.gather(x, d);
            const T energy = kernel_.gradient(d, pack.rest, by_difference);
            pack.scatter(by_difference, g);
            return energy;
          });
    });
  }

  Stencils stencils() const override { return packs_.stencils(); }

  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override {
    packs_.for_each_chunk([&](int first, int end) {
      for (int p = first; p < end; ++p) {
        Vector d[k - 1];
        Hessian h;
        packs_[p].gather(x, d);
        projected_hessian(kernel_, d, packs_[p].rest, projection, h);
        packs_[p].scatter(h, sink);
      }
    });
  }

 private:
  static constexpr int k = Kernel::vertices;
  using Packs = PackedElements<k, Kernel::Rest::SizeAtCompileTime>;
  using Elements = typename Packs::Elements;
  using T = typename Packs::T;
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Hessian = SymmetricMatrix<3 * (k - 1), T>;

  template <class Body>
  double sum_of_chunk(int first, int end, const Body& body) const {
    typename Packs::Sum sum;
    for (int p = first; p < end; ++p) sum.add(body(packs_[p]), packs_[p].active);
    return sum.total();
  }

  Packs packs_;
  [[no_unique_address]] Kernel kernel_;
};

}  // namespace drape
