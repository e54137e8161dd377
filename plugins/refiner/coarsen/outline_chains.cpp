#include "plugins/refiner/coarsen/outline_chains.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/numerics/mesh/seams.h"

namespace drape {
namespace {

/// The least distance of kept vertices along an outline that is finer than the cloth inside, over that
/// inside.
constexpr double densest = 0.8;

/// One flag a vertex: 1 where outlines meet, end or turn.
std::vector<char> corners_of(const Level& level, const FlatCloth& flat, const AdjacencyList& edges) {
  std::vector<int> in(flat.images.size(), -1), out(in), count(flat.images.size(), 0);
  for (const FlatCloth::Side& side : flat.outline)
    out[side.from] = side.to, in[side.to] = side.from, ++count[side.from];
  std::vector<char> corner(level.vertex_count(), 0);
  for (int i = 0; i < std::ssize(flat.images); ++i) {
    if (out[i] < 0) continue;
    const Eigen::Vector2d &at = flat.images[i].place, a = at - flat.images[in[i]].place,
                          b = flat.images[out[i]].place - at;
    const double turn = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    if (count[i] > 1 || std::abs(turn) > corner_angle) corner[flat.images[i].vertex] = 1;
  }
  for (int v = 0; v < level.vertex_count(); ++v)
    if (edges.size(v) > 0 && edges.size(v) != 2) corner[v] = 1;
  return corner;
}

}  // namespace

std::vector<OutlineChain> outline_chains(const Level& level, const FlatCloth& flat) {
  const auto& ends = level.topology.edges;
  std::vector<char> left(ends.rows(), 0);
  for (const FlatCloth::Side& side : flat.outline) left[side.edge] = 1;
  const AdjacencyList edges = AdjacencyList::of(level.vertex_count(), [&](const auto& add) {
    for (int e = 0; e < ends.rows(); ++e)
      if (left[e])
        for (const int v : ends.row(e)) add(v, e);
  });
  const std::vector<char> corner = corners_of(level, flat, edges);
  std::vector<OutlineChain> chains;
  const auto follow = [&](int from, int edge) {
    OutlineChain chain{{from}, {}};
    for (int v = from; edge >= 0;) {
      left[edge] = 0;
      chain.edges.push_back(edge);
      chain.vertices.push_back(v = ends(edge, 0) + ends(edge, 1) - v);
      edge = -1;
      if (corner[v] || v == from) break;
      for (const int e : edges.row(v))
        if (left[e]) edge = e;
    }
    chains.push_back(std::move(chain));
  };
  for (int v = 0; v < level.vertex_count(); ++v)
    if (corner[v])
      for (const int e : edges.row(v))
        if (left[e]) follow(v, e);
  for (int e = 0; e < ends.rows(); ++e)  // loops without a corner
    if (left[e]) follow(ends(e, 0), e);
  return chains;
}

std::vector<int> kept_of(const OutlineChain& chain, const Level& level, const FlatCloth& flat, double ratio) {
  const auto count = static_cast<int>(chain.edges.size());
  const auto inside = [&](int v) { return std::sqrt(4 / std::numbers::sqrt3 * flat.triangle_area[v]); };
  double length = 0;
  for (const int e : chain.edges) length += rest_length(level.rest, level.topology, e);
  const double own = length / count;
  std::vector<double> at = {0};  // of each vertex, in kept distances
  for (int k = 0; k < count; ++k) {
    const double local = (inside(chain.vertices[k]) + inside(chain.vertices[k + 1])) / 2;
    at.push_back(at.back() + rest_length(level.rest, level.topology, chain.edges[k]) /
                                 (std::sqrt(ratio) * std::max(own, densest * local)));
  }
  const bool closed = chain.vertices.front() == chain.vertices.back();
  const int parts =
      std::clamp(static_cast<int>(std::lround(at.back())), std::min(closed ? 3 : 1, count), count);
  std::vector<int> kept = {chain.vertices.front(), chain.vertices.back()};
  int k = 0;
  for (int part = 1; part < parts; ++part) {
    const double wanted = at.back() * part / parts;
    const int last = count - (parts - part);  // the others need one vertex each
    ++k;
    while (k < last && std::abs(at[k + 1] - wanted) < std::abs(at[k] - wanted)) ++k;
    kept.push_back(chain.vertices[k]);
  }
  return kept;
}

}  // namespace drape
