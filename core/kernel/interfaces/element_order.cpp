#include "core/kernel/interfaces/element_order.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "core/kernel/interfaces/topology.h"

namespace drape {
namespace {

/// Inserts two zeros after each of the lowest 21 bits.
std::uint64_t spread(std::uint64_t v) {
  v = (v | v << 32) & 0x001f00000000ffff;
  v = (v | v << 16) & 0x001f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  return (v | v << 2) & 0x1249249249249249;
}

std::vector<int> along_morton_curve(const Stencils& stencils, const Positions& rest) {
  const Eigen::RowVector3d low = rest.colwise().minCoeff();
  const double extent = (rest.colwise().maxCoeff() - low).maxCoeff();
  const double scale = extent > 0 ? 0x1fffff / extent : 0;
  std::vector<std::pair<std::uint64_t, int>> keys(stencils.rows());
  for (int e = 0; e < stencils.rows(); ++e) {
    Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
    for (int k = 0; k < stencils.cols(); ++k) centre += rest.row(stencils(e, k));
    const Eigen::RowVector3d cell = (centre / stencils.cols() - low) * scale;
    std::uint64_t key = 0;
    for (int c = 0; c < 3; ++c) key |= spread(static_cast<std::uint64_t>(std::max(cell[c], 0.0))) << c;
    keys[e] = {key, e};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<int> order(keys.size());
  std::transform(keys.begin(), keys.end(), order.begin(), [](const auto& key) { return key.second; });
  return order;
}

/// Greedy colouring of chunks of `size` elements: the lowest colour that no chunk with a common vertex has.
std::vector<int> colour_chunks(const Stencils& stencils, const std::vector<int>& order, int size,
                               int vertex_count) {
  std::vector<std::uint64_t> used(vertex_count, 0);  // for each vertex, one bit for each colour
  std::vector<int> colours;
  int overflow = 64;  // beyond 64 colours, a chunk gets its own
  for (int begin = 0, count = static_cast<int>(order.size()); begin < count; begin += size) {
    const int end = std::min(begin + size, count);
    std::uint64_t taken = 0;
    const auto for_vertices = [&](auto&& body) {
      for (int i = begin; i < end; ++i)
        for (int k = 0; k < stencils.cols(); ++k) body(used[stencils(order[i], k)]);
    };
    for_vertices([&](std::uint64_t& bits) { taken |= bits; });
    const int colour = std::countr_one(taken);
    colours.push_back(colour < 64 ? colour : overflow++);
    if (colour < 64) for_vertices([&](std::uint64_t& bits) { bits |= std::uint64_t{1} << colour; });
  }
  return colours;
}

}  // namespace

ElementOrder ElementOrder::of(const Stencils& stencils, const Positions& rest) {
  const int count = static_cast<int>(stencils.rows());
  if (count == 0) return {{}, {0}, {0}};
  // Small enough to balance the load, large enough to amortise scheduling.
  const int size = std::max(128, (count / max_chunks + 8) / 8 * 8);
  const std::vector<int> order = along_morton_curve(stencils, rest);
  const std::vector<int> colours = colour_chunks(stencils, order, size, static_cast<int>(rest.rows()));

  const int colour_count = *std::ranges::max_element(colours) + 1;
  const AdjacencyList chunks = AdjacencyList::of(colour_count, [&](const auto& add) {
    for (int chunk = 0; chunk < std::ssize(colours); ++chunk) add(colours[chunk], chunk);
  });
  ElementOrder result{{}, {0}, chunks.start};
  for (const int chunk : chunks.items) {
    const int begin = chunk * size, end = std::min(begin + size, count);
    result.elements.insert(result.elements.end(), order.begin() + begin, order.begin() + end);
    result.chunk_start.push_back(static_cast<int>(result.elements.size()));
  }
  return result;
}

}  // namespace drape
