#include "core/app/scene/crossed_parts.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/app/scene/scene.h"
#include "core/numerics/collision_detection/components.h"
#include "core/numerics/collision_detection/intersections.h"
#include "core/numerics/collision_detection/surface_search.h"
#include "core/numerics/mesh/area_vectors.h"
#include "core/numerics/mesh/disjoint_sets.h"
#include "core/numerics/mesh/mesh_faults.h"

namespace drape {

namespace {

using Eigen::Vector3d;

/// A motion along a surface may lead into it by this much of its length.
constexpr double along_surface = 0.1;
/// A motion out of a closed body by more than this part of its extent may lead past its middle.
constexpr double past_middle = 0.4;
/// An edge that is so nearly parallel to a motion sweeps no area: the next edges stand for it.
constexpr double parallel = 1e-6;

}  // namespace

CrossedParts::CrossedParts(const Level& level, const Positions& start, std::vector<TriangleMesh> obstacles,
                           const std::vector<double>& gaps)
    : start_(start), obstacles_(std::move(obstacles)) {
  for (std::size_t k = 0; k < obstacles_.size(); ++k)
    add(level, obstacles_[k], gaps.size() == obstacles_.size() && gaps[k] > 0);
  if (way_out_.norm() > 0) way_out_.normalize();
}

void CrossedParts::add(const Level& level, const TriangleMesh& obstacle, bool has_gap) {
  const TriangleMesh cloth{start_, level.rest.triangles};
  const int vertices = level.vertex_count();
  const bool closed =
      border_half_edges(obstacle.triangles, static_cast<int>(obstacle.vertices.rows())).empty();
  const Positions one_of_each = start_(components(level.topology), Eigen::all);
  const bool is_room = closed && is_inside(one_of_each, obstacle, true);
  const Positions normals = area_vectors(obstacle);
  const auto normal_of = [&](int triangle) -> Vector3d { return normals.row(triangle).normalized(); };
  const auto faces_inwards = [&] {
    const Positions corners = obstacle.vertices(obstacle.triangles.col(0), Eigen::all);
    return (corners.rowwise() - obstacle.vertices.row(0)).cwiseProduct(normals).sum() < 0;  // the volume
  };
  const double facing = closed && !is_room && faces_inwards() ? -1 : 1;
  std::vector<char> crosses(cloth.triangles.rows(), 0);
  const auto cuts = [&](const Vector3d& outwards) {
    if (closed) outwards_.push_back(outwards);
  };
  for (const TrianglePair& pair : intersections(cloth, obstacle)) {
    crosses[pair.first] = 1;
    way_out_ += facing * normal_of(pair.second);
    cuts(facing * normal_of(pair.second));
  }
  const bool is_cut = std::ranges::count(crosses, 1) > 0;
  if (closed && is_cut) cut_.push_back(obstacle.vertices);
  // What triangles without an intersection connect is on one side.
  DisjointSets sides(vertices);
  for (Eigen::Index t = 0; t < cloth.triangles.rows(); ++t)
    for (int k = 1; k < 3 && !crosses[t]; ++k) sides.unite(cloth.triangles(t, 0), cloth.triangles(t, k));
  std::vector<int> ones;  // a vertex of each side
  for (int v = 0; v < vertices; ++v)
    if (sides.find(v) == v) ones.push_back(v);
  const Positions at_ones = start_(ones, Eigen::all);
  std::vector<char> within, inwards;
  if (closed) {
    within = are_inside(at_ones, obstacle);
    inwards = are_inside(at_ones, obstacle, true);
  }
  const SurfaceSearch surface(obstacle);
  const auto is_behind = [&](const Vector3d& p) {
    const NearestPoint near = surface.nearest(p);
    return near.triangle >= 0 && near.offset.dot(normal_of(near.triangle)) < 0;
  };
  std::vector<char> behind(vertices, 0);
  for (std::size_t i = 0; i < ones.size(); ++i)
    behind[ones[i]] = closed ? is_room != (within[i] || inwards[i])
                             : (is_cut || !has_gap) && is_behind(at_ones.row(i).transpose());
  for (int v = 0; v < vertices; ++v) {
    behind[v] = behind[sides.find(v)];
    if (!behind[v]) continue;
    const Vector3d way = -surface.nearest(start_.row(v).transpose()).offset;
    depth_ = std::max(depth_, way.norm());
    cuts(way.normalized());
  }
  const auto is_free = [&](int t) { return t >= 0 && !crosses[t]; };
  std::vector<Eigen::Vector2i>& edges = free_edges_.emplace_back();
  for (Eigen::Index e = 0; e < level.topology.edges.rows(); ++e) {
    const auto triangles = level.topology.edge_triangles.row(e);
    if ((is_free(triangles[0]) || is_free(triangles[1])) && !behind[level.topology.edges(e, 0)])
      edges.emplace_back(level.topology.edges.row(e));
  }
}

bool CrossedParts::lead_across(const Vector3d& translation, double longest_edge) const {
  const double least = -along_surface * translation.norm();
  if (std::ranges::any_of(outwards_, [&](const Vector3d& out) { return out.dot(translation) < least; }))
    return true;
  for (const Positions& cut : cut_) {  // which a cloth near its middle cuts into halves
    const Eigen::VectorXd along = cut * translation.normalized();
    if (translation.norm() > std::max(longest_edge, past_middle * (along.maxCoeff() - along.minCoeff())))
      return true;
  }
  const int vertices = static_cast<int>(start_.rows());
  TriangleMesh swept{Positions(2 * vertices, 3), {}};
  swept.vertices << start_, start_.rowwise() + translation.transpose();
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    swept.triangles.resize(2 * static_cast<Eigen::Index>(free_edges_[k].size()), 3);
    Eigen::Index count = 0;
    for (const Eigen::Vector2i& edge : free_edges_[k]) {
      const Vector3d along = start_.row(edge[1]) - start_.row(edge[0]);
      if (along.cross(translation).norm() <= parallel * along.norm() * translation.norm()) continue;
      swept.triangles.row(count++) << edge[0], edge[1], edge[1] + vertices;
      swept.triangles.row(count++) << edge[0], edge[1] + vertices, edge[0] + vertices;
    }
    swept.triangles.conservativeResize(count, 3);
    if (!intersections(swept, obstacles_[k]).empty()) return true;
  }
  return false;
}

}  // namespace drape
