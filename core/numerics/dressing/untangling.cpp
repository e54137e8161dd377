#include "core/numerics/dressing/untangling.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/kernel/interfaces/topology.h"
#include "core/numerics/collision_detection/edge_crossings.h"
#include "core/numerics/collision_detection/intersections.h"
#include "core/numerics/collision_detection/surface_search.h"
#include "core/numerics/dressing/implicit_smoothing.h"

namespace drape {

namespace {

/// Each time of the smoothing that spreads a step over the cloth around it, a few edges wide first: steps
/// with it, and the length of one [mean edges].
constexpr double spreads[] = {1, 4, 16};
constexpr int steps_of_each = 100;
constexpr double step_length = 0.1;
/// Steps in which the obstacles' triangles that the cloth may reach stay the same ones.
constexpr int steps_of_reach = 25;
/// The steps with the next time follow if those with one leave at most this part of the pairs that cross.
constexpr double least_progress = 0.75;

TriangleMesh joined(const std::vector<TriangleMesh>& meshes) {
  TriangleMesh all;
  for (const TriangleMesh& mesh : meshes) {
    const Eigen::Index vertices = all.vertices.rows(), triangles = all.triangles.rows();
    all.vertices.conservativeResize(vertices + mesh.vertices.rows(), 3);
    all.vertices.bottomRows(mesh.vertices.rows()) = mesh.vertices;
    all.triangles.conservativeResize(triangles + mesh.triangles.rows(), 3);
    all.triangles.bottomRows(mesh.triangles.rows()) = mesh.triangles.array() + static_cast<int>(vertices);
  }
  return all;
}

/// The triangles of a mesh that are within reach of a surface [m], and may be some more.
TriangleMesh near_part(const TriangleMesh& mesh, const TriangleMesh& surface, double reach) {
  const SurfaceSearch search(surface);
  std::vector<int> near;
  for (int t = 0; t < mesh.triangles.rows(); ++t) {
    const Positions corners = mesh.vertices(mesh.triangles.row(t), Eigen::all);
    const Eigen::RowVector3d middle = corners.colwise().mean();
    bool is_near = false;
    search.visit_near(middle, reach + (corners.rowwise() - middle).rowwise().norm().maxCoeff(),
                      [&](int) { is_near = true; });
    if (is_near) near.push_back(t);
  }
  return {mesh.vertices, mesh.triangles(near, Eigen::all)};
}

/// The way of a cloth's vertices out of what they cross, of any length.
class WayOut {
 public:
  explicit WayOut(const TriangleMesh& cloth)
      : cloth_(cloth), moves_(Positions::Zero(cloth.vertices.rows(), 3)) {}

  const Positions& moves() const { return moves_; }

  /// Of a pair of its own triangles.
  void add(int first, int second) {
    add_edges(cloth_, first, cloth_, second);
    add_edges(cloth_, second, cloth_, first);
  }
  /// Of one of its triangles and one of an obstacle, which stays.
  void add(int own, const TriangleMesh& obstacle, int other) {
    add_edges(cloth_, own, obstacle, other);
    add_edges(obstacle, other, cloth_, own);
  }

 private:
  void add_edges(const TriangleMesh& mesh, int triangle, const TriangleMesh& other, int pierced) {
    const bool same = &mesh == &other;
    const auto corners = [](const TriangleMesh& of, int t) {
      return Eigen::Matrix3d(of.vertices(of.triangles.row(t), Eigen::all).transpose());
    };
    visit_edge_crossings(corners(mesh, triangle), corners(other, pierced), [&](const EdgeCrossing& at) {
      const int from = mesh.triangles(triangle, at.corner),
                to = mesh.triangles(triangle, (at.corner + 1) % 3);
      const auto own = other.triangles.row(pierced).array();
      if (same && (own == from || own == to).any()) return;  // they share a vertex
      const Eigen::RowVector3d way = at.away.transpose() / (same ? 2 : 1);
      if (&mesh == &cloth_) {
        moves_.row(from) += (1 - at.along) * way;
        moves_.row(to) += at.along * way;
      }
      for (int k = 0; k < 3 && &other == &cloth_; ++k)
        moves_.row(other.triangles(pierced, k)) -= at.weights[k] * way;
    });
  }

  const TriangleMesh& cloth_;
  Positions moves_;
};

double mean_edge(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles.rowwise())
    for (int k = 0; k < 3; ++k) sum += (mesh.vertices.row(t[k]) - mesh.vertices.row(t[(k + 1) % 3])).norm();
  return sum / (3 * std::max<Eigen::Index>(1, mesh.triangles.rows()));
}

}  // namespace

TriangleMesh untangled(TriangleMesh cloth, const std::vector<TriangleMesh>& obstacles) {
  const TriangleMesh all = joined(obstacles);
  const double length = step_length * mean_edge(cloth);
  TriangleMesh near;
  double most = std::numeric_limits<double>::infinity();  // pairs with which it goes on
  for (int step = 0; step < steps_of_each * static_cast<int>(std::size(spreads)); ++step) {
    if (step % steps_of_reach == 0) near = near_part(all, cloth, steps_of_reach * length);
    WayOut way(cloth);
    std::size_t pairs = 0;
    for (const TrianglePair& pair : self_intersections(cloth)) way.add(pair.first, pair.second), ++pairs;
    for (const TrianglePair& pair : intersections(cloth, near))
      way.add(pair.first, near, pair.second), ++pairs;
    if (pairs == 0) break;
    if (step % steps_of_each == 0 && pairs > std::exchange(most, least_progress * pairs)) break;
    const Positions moves = smoothed(cloth.triangles, way.moves(), spreads[step / steps_of_each]);
    const double longest = moves.rowwise().norm().maxCoeff();
    if (!(longest > 0)) break;
    cloth.vertices += length / longest * moves;
  }
  return cloth;
}

}  // namespace drape
