#pragma once

#include <utility>
#include <vector>

#include "core/kernel/interfaces/energy.h"
#include "core/numerics/elements/packed_elements.h"
#include "core/numerics/elements/project_hessian.h"

namespace drape {

/// A few packs of elements of k vertices, which a kernel evaluates together; unused ones repeat the last.
template <int k, int size>
struct ElementBatch {
  using T = Pack<native_pack_width>;
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Hessian = SymmetricMatrix<3 * (k - 1), T>;

  const Positions* x;
  const ElementPack<k>* elements[size];
  const T* rest[size];  ///< rest numbers of each pack

  /// The differences x_i - x_0 of a pack.
  void gather(int pack, Vector* d) const { elements[pack]->gather(*x, d); }
};

/// Sum of one kernel over many elements, as ElementEnergy, for a kernel that has a state of its own and needs
/// several packs at once to be fast. A Kernel has `vertices` (k), `batch` (packs), `Rest` (a fixed-size
/// vector of doubles) and, with Batch = ElementBatch<k, batch>,
///
///     void value(const Batch&, T* energies) const;
///     void gradient(const Batch&, T* energies, Vector (*g)[k - 1]) const;
///     void hessian(const Batch&, Projection, Batch::Hessian* h) const;  // projected
///
/// for all packs of the batch. NaN energies count as +∞.
template <class Kernel>
class BatchedEnergy final : public BoundEnergy {
 public:
  BatchedEnergy(Kernel kernel, const Stencils& elements, const std::vector<typename Kernel::Rest>& rest,
                ElementOrder order)
      : kernel_(std::move(kernel)), packs_(elements, rest, std::move(order)) {}

  double value(const Positions& x) const override {
    return packs_.sum([&](int first, int end) {
      typename Packs::Sum sum;
      for_each_batch(first, end, x, [&](const Batch& batch, int p, int count) {
        T energies[size];
        kernel_.value(batch, energies);
        for (int i = 0; i < count; ++i) sum.add(energies[i], packs_[p + i].active);
      });
      return sum.total();
    });
  }

  double add_gradient(const Positions& x, Positions& g) const override {
    return packs_.sum_scattered([&](int first, int end) {
      typename Packs::Sum sum;
      for_each_batch(first, end, x, [&](const Batch& batch, int p, int count) {
        T energies[size];
        typename Batch::Vector by_difference[size][k - 1];
        kernel_.gradient(batch, energies, by_difference);
        scatter(by_difference, p, count, g);
        for (int i = 0; i < count; ++i) sum.add(energies[i], packs_[p + i].active);
      });
      return sum.total();
    });
  }

  Stencils stencils() const override { return packs_.stencils(); }

  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override {
    packs_.for_each_chunk([&](int first, int end) {
      for_each_batch(first, end, x, [&](const Batch& batch, int p, int count) {
        typename Batch::Hessian h[size];
        kernel_.hessian(batch, projection, h);
        for (int i = 0; i < count; ++i) packs_[p + i].scatter(h[i], sink);
      });
    });
  }

 private:
  static constexpr int k = Kernel::vertices, size = Kernel::batch;
  using Batch = ElementBatch<k, size>;
  using T = typename Batch::T;
  using Packs = PackedElements<k, Kernel::Rest::SizeAtCompileTime>;

  template <class Body>
  void for_each_batch(int first, int end, const Positions& x, const Body& body) const {
    for (int p = first; p < end; p += size) {
      const int count = std::min(size, end - p);
      Batch batch;
      batch.x = &x;
      for (int i = 0; i < size; ++i) {
        const auto& pack = packs_[p + std::min(i, count - 1)];
        batch.elements[i] = &pack;
        batch.rest[i] = pack.rest;
      }
      body(batch, p, count);
    }
  }

  // As in ElementEnergy: a pack stays in registers only if everything is inlined.
  [[gnu::flatten]] void scatter(const typename Batch::Vector (*by_difference)[k - 1], int p, int count,
                                Positions& g) const {
    for (int i = 0; i < count; ++i) packs_[p + i].scatter(by_difference[i], g);
  }

  Kernel kernel_;
  Packs packs_;
};

}  // namespace drape
