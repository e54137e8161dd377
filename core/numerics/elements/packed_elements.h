#pragma once

#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/elements/element_pack.h"

namespace drape {

/// The elements of an energy in packs of W with their rest numbers, chunk by chunk of an order, and sums over
/// them. Energies that are NaN or -∞ count as +∞.
template <int k, int rest_size, int W>
class PackedElements {
 public:
  using T = Pack<W>;
  struct Elements : ElementPack<k, W> {
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

  /// The same where the body writes to its elements' vertices.
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
