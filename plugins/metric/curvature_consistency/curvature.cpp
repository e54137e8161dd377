#include "plugins/metric/curvature_consistency/curvature.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/elements/vertex_fields.h"
#include "core/numerics/mesh/area_vectors.h"
#include "plugins/metric/curvature_consistency/quadric.h"

namespace drape {
namespace {

using Eigen::Vector3d;

constexpr int grain = 1024;  // vertices a piece; each piece allocates a mark per vertex of the mesh

Vector3d vertex(const Positions& x, int i) { return x.row(i).transpose(); }

Positions vertex_normals(const Positions& x, const Triangles& triangles) {
  Positions normals = smooth_normals({x, triangles});
  for (Eigen::Index i = 0; i < normals.rows(); ++i)
    if (normals.row(i).isZero(0))
      throw std::runtime_error("curvature: the triangles around vertex " + std::to_string(i) +
                               " have no common normal; they are degenerate or folded flat onto each other");
  return normals;
}

/// Vertices within some edges of a centre, by breadth-first search; the marks are reused between centres.
class RingSearch {
 public:
  RingSearch(const AdjacencyList& neighbours, int vertex_count)
      : neighbours_(neighbours), marks_(vertex_count, -1) {}

  /// The vertices around `centre`, without itself, ring after ring; valid until the next call.
  const std::vector<int>& around(int centre, int rings) {
    found_.assign(1, centre);
    marks_[centre] = centre;
    std::size_t next = 0;
    for (int ring = 0; ring < rings && next < found_.size(); ++ring)
      for (const std::size_t last = found_.size(); next < last; ++next) {
        const int from = found_[next];
        for (const int j : neighbours_.row(from)) {
          if (marks_[j] == centre) continue;
          marks_[j] = centre;
          found_.push_back(j);
        }
      }
    found_.erase(found_.begin());
    return found_;
  }

 private:
  const AdjacencyList& neighbours_;
  std::vector<int> marks_;
  std::vector<int> found_;
};

}  // namespace

VertexCurvatures fit_curvatures(const Positions& x, const Triangles& triangles, const Topology& topology,
                                int rings) {
  const int n = static_cast<int>(x.rows());
  const Positions normals = vertex_normals(x, triangles);
  VertexCurvatures result{Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n)};
  parallel_for(n, grain, [&](int begin, int end) {
    RingSearch search(topology.vertex_vertices, n);
    std::vector<Vector3d> offsets;
    for (int i = begin; i < end; ++i) {
      const Vector3d normal = vertex(normals, i), u = normal.unitOrthogonal(), v = normal.cross(u);
      double scale = 0;  // fitting in units of the neighbourhood keeps the normal matrix well conditioned
      const std::vector<int>& around = search.around(i, rings);  // a second search would find none unmarked
      const auto gather = [&](bool all) {
        offsets.clear();
        for (const int j : around) {
          if (!all && normals.row(j).dot(normals.row(i)) <= 0) continue;
          const Vector3d offset = vertex(x, j) - vertex(x, i);
          offsets.emplace_back(offset.dot(u), offset.dot(v), offset.dot(normal));
          scale = std::max(scale, offsets.back().norm());
        }
      };
      gather(false);
      if (offsets.size() < 5) gather(true);  // as libigl: five unknowns need five neighbours
      for (Vector3d& offset : offsets) offset /= scale;
      const PointCurvatures at_i = quadric_curvatures(fit_quadric(offsets));
      result.mean[i] = at_i.mean / scale;
      result.gaussian[i] = at_i.gaussian / (scale * scale);
      const double kappa1 = at_i.kappa1 / scale, kappa2 = at_i.kappa2 / scale;
      result.strongest[i] = std::abs(kappa1) >= std::abs(kappa2) ? kappa1 : kappa2;
    }
  });
  return result;
}

VertexCurvatures ddg_curvatures(const Positions& x, const Triangles& triangles, const Topology& topology) {
  VertexCurvatures result{
      mean_curvature(x, triangles, topology.hinges(triangles)), Eigen::VectorXd(x.rows()), {}};
  parallel_for(static_cast<int>(x.rows()), grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      double angles = 0, area = 0;
      for (const int t : topology.vertex_triangles.row(i)) {
        const int k = triangles(t, 0) == i ? 0 : triangles(t, 1) == i ? 1 : 2;
        const Vector3d to_next = vertex(x, triangles(t, (k + 1) % 3)) - vertex(x, i);
        const Vector3d to_last = vertex(x, triangles(t, (k + 2) % 3)) - vertex(x, i);
        const double twice_area = to_next.cross(to_last).norm();
        angles += std::atan2(twice_area, to_next.dot(to_last));
        area += twice_area / 6;
      }
      if (!(area > 0))
        throw std::runtime_error("curvature: the triangles around vertex " + std::to_string(i) +
                                 " have no area");
      const double whole = topology.on_border[i] ? std::numbers::pi : 2 * std::numbers::pi;
      result.gaussian[i] = (whole - angles) / area;
    }
  });
  return result;
}

}  // namespace drape
