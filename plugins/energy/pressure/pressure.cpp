#include <Eigen/Geometry>
#include <numeric>
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

/// The volume as a sum over edges (a, b) with triangles (a, b, c) and (b, a, d), all relative to one origin:
///
///     V = Σ det(a, b, c - d) / 18,   ∂V/∂a = Σ b × (c - d) / 12,   ∂²V/∂a∂b = -[c - d]× / 6.
///
/// Every triangle contributes a third of its det / 6 to each edge. At the border d is the centre. In this
/// form the Hessian does not depend on the origin, and its projection has a closed form.
class BoundPressure final : public BoundEnergy {
 public:
  BoundPressure(double pressure, Vector centre, const Level& level)
      : pressure_(pressure), centre_(std::move(centre)) {
    const Topology& topology = level.topology;
    const Stencils& inner = level.hinges;
    const Eigen::Index edges = topology.edges.rows();
    closed_ = inner.rows() == edges;
    Stencils all(edges, 4);
    all.topRows(inner.rows()) = inner;
    Eigen::Index next = inner.rows();
    for (int t = 0; t < level.triangle_count(); ++t)
      for (int k = 0; k < 3; ++k) {
        if (topology.edge_triangles(topology.triangle_edges(t, k), 1) >= 0) continue;
        const auto v = level.rest.triangles.row(t);
        all.row(next++) << v[(k + 1) % 3], v[(k + 2) % 3], v[k], -1;
      }
    order_ = ElementOrder::of(all.leftCols(2), level.rest.vertices);
    edges_ = in_order(all, order_);
  }

  double value(const Positions& x) const override {
    const Vector origin = origin_at(x);
    return energy(parallel_sum(order_.chunks(), 1, [&](int chunk, int) {
      double sum = 0;
      for (int e = order_.chunk_start[chunk]; e < order_.chunk_start[chunk + 1]; ++e)
        sum += determinant(Edge(*this, x, origin, e));
      return sum;
    }));
  }

  double add_gradient(const Positions& x, Positions& g) const override {
    const Vector origin = origin_at(x);
    const double scale = -pressure_ / 12;
    std::vector<double> sums(order_.chunks());
    order_.for_each_chunk([&](int c) {
      double sum = 0;
      for (int e = order_.chunk_start[c]; e < order_.chunk_start[c + 1]; ++e) {
        const Edge edge(*this, x, origin, e);
        g.row(edges_(e, 0)) += scale * edge.b.cross(edge.across).transpose();
        g.row(edges_(e, 1)) -= scale * edge.a.cross(edge.across).transpose();
        sum += determinant(edge);
      }
      sums[c] = sum;
    });
    return energy(std::accumulate(sums.begin(), sums.end(), 0.0));
  }

  Stencils stencils() const override { return edges_.leftCols(2); }

  /// An edge's matrix is M = [0 S; Sᵀ 0] with S = p [w]× / 6. M² is a multiple of the projection P = I - n nᵀ
  /// across w on both vertices, n = w/|w|, and |M| = |p| |w| / 6 times it.
  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override {
    const bool clamp = projection.kind == Projection::clamp;
    const double lifted = projection.is_exact() ? 0 : clamp ? projection.blend / 2 : projection.blend;
    const Vector origin = origin_at(x);
    order_.for_each_chunk([&](int c) {
      for (int e = order_.chunk_start[c]; e < order_.chunk_start[c + 1]; ++e) {
        const Vector w = Edge(*this, x, origin, e).across;
        const Vector s = (1 - lifted) * pressure_ / 6 * w;
        const double off[9] = {0, -s.z(), s.y(), s.z(), 0, -s.x(), -s.y(), s.x(), 0};
        sink.add(e, 0, 1, off);
        const double length = w.norm();
        if (lifted == 0 || length == 0) continue;
        Eigen::Matrix<double, 3, 3, Eigen::RowMajor> own = -w * (w / length).transpose();
        own.diagonal().array() += length;
        own *= lifted * std::abs(pressure_) / 6;
        sink.add(e, 0, 0, own.data());
        sink.add(e, 1, 1, own.data());
      }
    });
  }

 private:
  struct Edge {
    Vector a, b, across;  ///< ends, from the origin, and c - d
    Edge(const BoundPressure& of, const Positions& x, const Vector& origin, int e) {
      const auto v = of.edges_.row(e);
      a = x.row(v[0]).transpose() - origin;
      b = x.row(v[1]).transpose() - origin;
      across = x.row(v[2]);
      across -= v[3] >= 0 ? Vector(x.row(v[3])) : of.centre_;
    }
  };

  static double determinant(const Edge& edge) { return edge.a.dot(edge.b.cross(edge.across)); }

  /// Origin of the coordinates, on the cloth: keeps accuracy far from the global origin. A closed surface's
  /// volume does not depend on it.
  Vector origin_at(const Positions& x) const { return closed_ ? Vector(x.row(0)) : centre_; }

  /// From the sum of the determinants.
  double energy(double sum) const { return -pressure_ * sum / 18; }

  double pressure_;
  Vector centre_;
  bool closed_ = false;
  ElementOrder order_;
  Stencils edges_;  ///< a, b, c, d in order_; d is -1 at the border
};

}  // namespace

/// Follower pressure E = -p V(x) with the enclosed volume V. A cone from its border to a fixed centre closes
/// an open cloth.
class Pressure final : public Energy {
 public:
  double pressure = 0;
  Eigen::Vector3d centre{0, 0, 0};

  static void declare(Declaration<Pressure>& d) {
    d.add("pressure", &Pressure::pressure,
          "pressure along the normal of every triangle; negative for suction")
        .unit("Pa")
        .between(-bounds::largest_load, bounds::largest_load)
        .required();
    d.add("centre", &Pressure::centre,
          "apex of the cone that closes an open cloth; it has no effect on a pinned border or a closed "
          "mesh")
        .unit("m")
        .between(-bounds::largest_coordinate, bounds::largest_coordinate);
  }

  EnergyRole role() const override { return EnergyRole::external; }
  std::optional<double> midpoint_factor() const override { return 1; }
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material&) const override {
    return std::make_unique<BoundPressure>(pressure, centre, level);
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::Pressure>(
      "pressure", "Pressure that turns with the cloth, as in a balloon: -p times the enclosed volume.");
}
