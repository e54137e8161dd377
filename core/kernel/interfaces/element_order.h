#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/kernel/interfaces/block_sink.h"
#include "core/kernel/interfaces/triangle_mesh.h"
#include "core/kernel/threads/parallel.h"

namespace drape {

/// Order of elements in coloured chunks. Chunks of one colour share no vertex, so threads can scatter from
/// them concurrently. It depends only on the mesh: sums have the same bits with any number of threads.
struct ElementOrder {
  std::vector<int> elements;      ///< the element at each position
  std::vector<int> chunk_start;   ///< chunks + 1 positions; all chunk lengths but one are multiples of 8
  std::vector<int> colour_start;  ///< colours + 1 chunk indices

  static constexpr int max_chunks = 256;

  /// Sorts the elements' rest centroids along a space-filling curve, cuts chunks, and colours them greedily.
  static ElementOrder of(const Stencils& stencils, const Positions& rest);

  int chunks() const { return static_cast<int>(chunk_start.size()) - 1; }
  int colours() const { return static_cast<int>(colour_start.size()) - 1; }

  /// Calls body(chunk) for every chunk: colour after colour, chunks of one colour concurrently.
  template <class Body>
  void for_each_chunk(const Body& body) const {
    for (int colour = 0; colour < colours(); ++colour) {
      const int first = colour_start[colour];
      parallel_for(colour_start[colour + 1] - first, 1, [&](int begin, int end) {
        for (int c = first + begin; c < first + end; ++c) body(c);
      });
    }
  }
};

}  // namespace drape
