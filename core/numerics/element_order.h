#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/numerics/block_matrix.h"
#include "core/numerics/parallel.h"

namespace drape {

/// An order of elements in chunks that several threads can scatter from: chunks of one colour share no
/// vertex. It depends on the mesh alone, so that sums over it are the same with any number of threads.
struct ElementOrder {
  std::vector<int> elements;      ///< the element at each place
  std::vector<int> chunk_start;   ///< chunks + 1 places; all chunks but one are multiples of 8 long
  std::vector<int> colour_start;  ///< colours + 1 chunks

  static constexpr int max_chunks = 256;

  /// Sorts along a space-filling curve of the elements' rest centroids, cuts, and colours greedily.
  static ElementOrder of(const Stencils& stencils, const Positions& rest);

  int chunks() const { return static_cast<int>(chunk_start.size()) - 1; }
  int colours() const { return static_cast<int>(colour_start.size()) - 1; }

  /// body(chunk) for every chunk, those of one colour at the same time, colour after colour.
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
