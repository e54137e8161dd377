#include <Eigen/Geometry>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/element_order.h"
#include "core/kernel/interfaces/energy.h"
#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/parameters.h"
#include "core/kernel/plugin/plugin.h"
#include "core/kernel/threads/parallel.h"
#include "core/numerics/elements/packed_elements.h"

namespace drape {
namespace {

using Vector = Eigen::Vector3d;

/// The border's loops as vertices, each in the direction of its triangles. A vertex must be on one loop at
/// most.
AdjacencyList border_loops(const Level& level) {
  std::vector<int> next(level.vertex_count(), -1);
  for (int t = 0; t < level.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) {
      const HalfEdge side = HalfEdge::of(level.rest.triangles, 3 * t + k);
      if (level.topology.edge_triangles(level.topology.triangle_edges(t, k), 1) < 0)
        next[side.from] = side.to;
    }
  AdjacencyList loops{{0}, {}};
  for (int first = 0; first < level.vertex_count(); ++first) {
    for (int v = first; next[v] >= 0;) {
      loops.items.push_back(v);
      v = std::exchange(next[v], -1);
    }
    if (std::ssize(loops.items) > loops.start.back()) loops.start.push_back(std::ssize(loops.items));
  }
  return loops;
}

/// The volume V that the cloth and the fans of its border loops from their mean points m enclose, as a sum
/// over edges (a, b) with triangles (a, b, c) and (b, a, d), all relative to one origin:
///
///     V = Σ det(a, b, c - d) / 18,   ∂V/∂a = Σ b × (c - d) / 12,   ∂²V/∂a∂b = -[c - d]× / 6.
///
/// Every triangle contributes a third of its det / 6 to each edge. At the border d is m. What this leaves out
/// of the fan of a loop of k vertices, with S = Σ a × b over its edges and w the difference of a vertex'
/// neighbours along it (the next one less the one before), is
///
///     V: -m·S / 9,   ∂/∂i: -S / 6k - w_i × m / 12,   ∂²/∂i∂j: -[w_i - w_j]× / 6k, for all pairs of the loop.
///
/// In this form the Hessian does not depend on the origin, and its projection has a closed form.
class BoundPressure final : public BoundEnergy {
 public:
  BoundPressure(double pressure, const Level& level) : pressure_(pressure), loops_(border_loops(level)) {
    const Topology& topology = level.topology;
    const Stencils& inner = level.hinges;
    std::vector<int> loop_of(level.vertex_count(), -1);
    for (int l = 0; l < loop_count(); ++l)
      for (const int v : loops_.row(l)) loop_of[v] = l;
    Stencils all(topology.edges.rows(), 4);
    all.topRows(inner.rows()) = inner;
    Eigen::Index next = inner.rows();
    for (int t = 0; t < level.triangle_count(); ++t)
      for (int k = 0; k < 3; ++k) {
        if (topology.edge_triangles(topology.triangle_edges(t, k), 1) >= 0) continue;
        const auto v = level.rest.triangles.row(t);
        const int from = v[(k + 1) % 3];
        all.row(next++) << from, v[(k + 2) % 3], v[k], ~loop_of[from];
      }
    order_ = ElementOrder::of(all.leftCols(2), level.rest.vertices);
    edges_ = in_order(all, order_);
    bind_pairs(level);
  }

  double value(const Positions& x) const override {
    const std::vector<Fan> fans = fans_at(x);
    const Vector origin = origin_at(x);
    return energy(fans, parallel_sum(order_.chunks(), 1, [&](int chunk, int) {
                    double sum = 0;
                    for (int e = order_.chunk_start[chunk]; e < order_.chunk_start[chunk + 1]; ++e)
                      sum += determinant(Edge(*this, x, origin, fans, e));
                    return sum;
                  }));
  }

  double add_gradient(const Positions& x, Positions& g) const override {
    const std::vector<Fan> fans = fans_at(x);
    const Vector origin = origin_at(x);
    const double scale = -pressure_ / 12;
    std::vector<double> sums(order_.chunks());
    order_.for_each_chunk([&](int c) {
      double sum = 0;
      for (int e = order_.chunk_start[c]; e < order_.chunk_start[c + 1]; ++e) {
        const Edge edge(*this, x, origin, fans, e);
        g.row(edges_(e, 0)) += scale * edge.b.cross(edge.across).transpose();
        g.row(edges_(e, 1)) -= scale * edge.a.cross(edge.across).transpose();
        sum += determinant(edge);
      }
      sums[c] = sum;
    });
    for (int l = 0; l < loop_count(); ++l)
      for (int i = 0; i < loops_.size(l); ++i) {
        const Vector own = 2.0 / loops_.size(l) * fans[l].area + along(x, l, i).cross(fans[l].apex);
        g.row(loops_.begin(l)[i]) -= scale * own.transpose();
      }
    return energy(fans, std::accumulate(sums.begin(), sums.end(), 0.0));
  }

  Stencils stencils() const override {
    Stencils all(edges_.rows() + pairs_.rows(), 2);
    all.topRows(edges_.rows()) = edges_.leftCols(2);
    all.bottomRows(pairs_.rows()) = pairs_.leftCols(2);
    return all;
  }

  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override {
    const std::vector<Fan> fans = fans_at(x);
    const Vector origin = origin_at(x);
    order_.for_each_chunk([&](int c) {
      for (int e = order_.chunk_start[c]; e < order_.chunk_start[c + 1]; ++e)
        add_block(Edge(*this, x, origin, fans, e).across, projection, sink, e);
    });
    BlockSink of_pairs = sink.from(static_cast<int>(edges_.rows()));
    pair_order_.for_each_chunk([&](int c) {
      for (int e = pair_order_.chunk_start[c]; e < pair_order_.chunk_start[c + 1]; ++e) {
        const auto pair = pairs_.row(e);
        const Vector across = along(x, pair[2], pair[3]) - along(x, pair[2], pair[4]);
        add_block(across / loops_.size(pair[2]), projection, of_pairs, e);
      }
    });
  }

 private:
  /// The fan of a loop, from the origin.
  struct Fan {
    Vector apex;  ///< m
    Vector area;  ///< S, twice its area vector
  };

  struct Edge {
    Vector a, b, across;  ///< ends, from the origin, and c - d
    Edge(const BoundPressure& of, const Positions& x, const Vector& origin, const std::vector<Fan>& fans,
         int e) {
      const auto v = of.edges_.row(e);
      a = x.row(v[0]).transpose() - origin;
      b = x.row(v[1]).transpose() - origin;
      if (v[3] >= 0)
        across = x.row(v[2]) - x.row(v[3]);
      else
        across = x.row(v[2]).transpose() - origin - fans[~v[3]].apex;
    }
  };

  /// All pairs of vertices of each loop, each with the loop and the places of both in it.
  void bind_pairs(const Level& level) {
    Eigen::Index count = 0;
    for (Eigen::Index l = 0, k = 0; l < loop_count(); ++l) k = loops_.size(l), count += k * (k - 1) / 2;
    Stencils all(count, 5);
    Eigen::Index next = 0;
    for (int l = 0; l < loop_count(); ++l)
      for (int i = 0; i < loops_.size(l); ++i)
        for (int j = i + 1; j < loops_.size(l); ++j)
          all.row(next++) << loops_.begin(l)[i], loops_.begin(l)[j], l, i, j;
    pair_order_ = ElementOrder::of(all.leftCols(2), level.rest.vertices);
    pairs_ = in_order(all, pair_order_);
  }

  /// A pair's matrix is M = [0 S; Sᵀ 0] with S = p [w]× / 6. M² is a multiple of the projection P = I - n nᵀ
  /// across w on both vertices, n = w/|w|, and |M| = |p| |w| / 6 times it.
  void add_block(const Vector& w, Projection projection, BlockSink& sink, int e) const {
    const bool clamp = projection.kind == Projection::clamp;
    const double lifted = projection.is_exact() ? 0 : clamp ? projection.blend / 2 : projection.blend;
    const Vector s = (1 - lifted) * pressure_ / 6 * w;
    const double off[9] = {0, -s.z(), s.y(), s.z(), 0, -s.x(), -s.y(), s.x(), 0};
    sink.add(e, 0, 1, off);
    const double length = w.norm();
    if (lifted == 0 || length == 0) return;
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> own = -w * (w / length).transpose();
    own.diagonal().array() += length;
    own *= lifted * std::abs(pressure_) / 6;
    sink.add(e, 0, 0, own.data());
    sink.add(e, 1, 1, own.data());
  }

  static double determinant(const Edge& edge) { return edge.a.dot(edge.b.cross(edge.across)); }

  int loop_count() const { return static_cast<int>(loops_.start.size()) - 1; }

  /// w of the vertex at place i of a loop.
  Vector along(const Positions& x, int loop, int i) const {
    const std::span<const int> v = loops_.row(loop);
    const int k = loops_.size(loop);
    return x.row(v[(i + 1) % k]) - x.row(v[(i + k - 1) % k]);
  }

  std::vector<Fan> fans_at(const Positions& x) const {
    const Vector origin = origin_at(x);
    std::vector<Fan> fans;
    for (int l = 0; l < loop_count(); ++l) {
      Fan& fan = fans.emplace_back(Fan{Vector::Zero(), Vector::Zero()});
      Vector before = x.row(loops_.end(l)[-1]).transpose() - origin;
      for (const int v : loops_.row(l)) {
        const Vector own = x.row(v).transpose() - origin;
        fan.apex += own / loops_.size(l);
        fan.area += before.cross(own);
        before = own;
      }
    }
    return fans;
  }

  /// Origin of the coordinates, on the cloth: keeps accuracy far from the global origin. The volume does not
  /// depend on it.
  static Vector origin_at(const Positions& x) { return x.row(0); }

  /// From the sum of the determinants.
  double energy(const std::vector<Fan>& fans, double sum) const {
    for (const Fan& fan : fans) sum -= 2 * fan.apex.dot(fan.area);
    return -pressure_ * sum / 18;
  }

  double pressure_;
  AdjacencyList loops_;
  ElementOrder order_, pair_order_;
  Stencils edges_;  ///< a, b, c, d in order_; at the border d is ~ the loop's number
  Stencils pairs_;  ///< i, j, the loop's number and the places of i and j in it, in pair_order_
};

}  // namespace

/// Follower pressure E = -p V(x) with the enclosed volume V. Each border loop of an open cloth is closed by
/// its fan from its mean point, which moves with the cloth.
class Pressure final : public Energy {
 public:
  double pressure = 0;

  static void declare(Declaration<Pressure>& d) {
    d.add("pressure", &Pressure::pressure,
          "pressure along the normal of every triangle; negative for suction")
        .unit("Pa")
        .between(-bounds::largest_load, bounds::largest_load)
        .required();
  }

  EnergyRole role() const override { return EnergyRole::external; }
  std::optional<double> midpoint_factor() const override { return 1; }
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material&) const override {
    return std::make_unique<BoundPressure>(pressure, level);
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::Pressure>(
      "pressure", "Pressure that turns with the cloth, as in a balloon: -p times the enclosed volume.");
}
