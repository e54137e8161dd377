#include "plugins/refiner/coarsen/curved_cloth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "core/numerics/hierarchy/rest_interpolation.h"
#include "core/numerics/patterns/delaunay.h"
#include "plugins/refiner/coarsen/outline_chains.h"

namespace drape {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

/// New triangles have no smaller angles, unless there were some, and face where the vertex' triangles did, up
/// to this angle [rad].
constexpr double smallest_angle = 20 * std::numbers::pi / 180, most_turned = std::numbers::pi / 3;

double angle_between(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// The neighbours of a vertex, counter-clockwise; those at the ends are on the border if it is.
struct Ring {
  std::vector<int> vertices;
  std::vector<double> angles;  ///< between one and the next [rad]
  bool is_closed = true;

  double total() const {
    double sum = 0;
    for (const double angle : angles) sum += angle;
    return sum;
  }
};

/// A mesh that loses vertices, and keeps where the lost ones rest.
class ShrinkingMesh {
 public:
  explicit ShrinkingMesh(const Level& fine)
      : fine_(fine), around_(fine.vertex_count()), left_(fine.vertex_count()) {
    spacing_.resize(fine.vertex_count());
    for (const auto& t : fine.rest.triangles.rowwise()) add({t[0], t[1], t[2]});
    for (int v = 0; v < fine.vertex_count(); ++v)
      spacing_[v] =
          3 * fine.vertex_area[v] / static_cast<double>(std::max<std::size_t>(1, around_[v].size()));
    cost_.resize(fine.vertex_count(), -1);
    for (int v = 0; v < fine.vertex_count(); ++v) offer(v);
  }

  /// Down to this number of vertices, or as few as can be.
  void shrink(int wanted) {
    while (left_ > wanted && !offered_.empty()) {
      const int v = offered_.begin()->second;
      withdraw(v);
      if (!remove(v)) continue;  // offered again once its ring has changed
      --left_;
    }
  }

  CoarseSurface surface() const {
    CoarseSurface result;
    std::vector<int> number(fine_.vertex_count(), -1), index(triangles_.size(), -1), all;
    for (int v = 0; v < fine_.vertex_count(); ++v)
      if (!around_[v].empty())
        number[v] = static_cast<int>(result.vertices.size()), result.vertices.push_back(v);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (!alive_[t]) continue;
      index[t] = static_cast<int>(all.size() / 3);
      all.insert(all.end(), triangles_[t].begin(), triangles_[t].end());
    }
    result.triangles = Eigen::Map<const Triangles>(all.data(), static_cast<Eigen::Index>(all.size() / 3), 3);
    std::vector<Eigen::Triplet<double>> entries;
    for (const int v : result.vertices) entries.emplace_back(v, number[v], 1);
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (const int v : lost_[t]) {
        // The triangle that was nearest before may have a nearer one beside it.
        EmbeddedPoint nearest;
        for (const int corner : triangles_[t])
          for (const int near : around_[corner]) take_nearer(nearest, v, result.triangles, index[near]);
        for (int k = 0; k < 3; ++k)
          entries.emplace_back(v, number[result.triangles(nearest.triangle, k)], nearest.weights[k]);
      }
    result.weights.resize(fine_.vertex_count(), static_cast<Eigen::Index>(result.vertices.size()));
    result.weights.setFromTriplets(entries.begin(), entries.end());
    return result;
  }

 private:
  using Corners = std::array<int, 3>;

  Vector3d place(int v) const { return fine_.rest.vertices.row(v); }
  Vector3d area_vector(const Corners& t) const {
    return (place(t[1]) - place(t[0])).cross(place(t[2]) - place(t[0])) / 2;
  }
  double least_angle(const Corners& t) const {
    double least = std::numbers::pi;
    for (int k = 0; k < 3; ++k)
      least = std::min(
          least, angle_between(place(t[(k + 1) % 3]) - place(t[k]), place(t[(k + 2) % 3]) - place(t[k])));
    return least;
  }

  int add(const Corners& corners) {
    const auto t = static_cast<int>(triangles_.size());
    triangles_.push_back(corners);
    alive_.push_back(1);
    lost_.emplace_back();
    for (const int v : corners) around_[v].push_back(t);
    return t;
  }
  void drop(int t) {
    alive_[t] = 0;
    for (const int v : triangles_[t]) std::erase(around_[v], t);
  }

  /// How much of the mesh a vertex stands for: the area around it, in triangles of the fine mesh there; more
  /// where that is curved.
  void offer(int v) {
    withdraw(v);
    double area = 0;
    Vector3d sum(0, 0, 0);
    for (const int t : around_[v]) {
      const Vector3d own = area_vector(triangles_[t]);
      double fine = 0;
      for (const int corner : triangles_[t]) fine += spacing_[corner] / 3;
      area += own.norm() / fine;
      sum += own / fine;
    }
    if (fine_.topology.on_border[v]) area *= 2;
    const double flatness = std::max(0.1, sum.norm() * (fine_.topology.on_border[v] ? 2 : 1) / area);
    cost_[v] = area / (flatness * flatness);
    offered_.emplace(cost_[v], v);
  }
  void withdraw(int v) {
    if (cost_[v] >= 0) offered_.erase({cost_[v], v});
    cost_[v] = -1;
  }

  std::optional<Ring> ring_of(int v) const {
    const auto& around = around_[v];
    std::vector<std::pair<int, int>> sides;  // opposite v, in each triangle's direction
    for (const int t : around) {
      const Corners& c = triangles_[t];
      const auto k = std::ranges::find(c, v) - c.begin();
      sides.emplace_back(c[(k + 1) % 3], c[(k + 2) % 3]);
    }
    Ring ring;
    ring.is_closed = !fine_.topology.on_border[v];
    int at = sides.front().first;
    if (!ring.is_closed)
      for (const auto& side : sides)
        if (std::ranges::none_of(sides, [&](const auto& other) { return other.second == side.first; }))
          at = side.first;
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const auto next = std::ranges::find(sides, at, &std::pair<int, int>::first);
      if (next == sides.end()) return std::nullopt;
      ring.vertices.push_back(at);
      ring.angles.push_back(angle_between(place(at) - place(v), place(next->second) - place(v)));
      at = next->second;
    }
    if (!ring.is_closed) ring.vertices.push_back(at);
    return ring;
  }

  /// The triangles that fill the hole of a vertex, if they make a mesh like the one before.
  std::optional<std::vector<Corners>> filling(int v, const Ring& ring) const {
    const double half = std::numbers::pi, whole = ring.is_closed ? 2 * half : half, total = ring.total();
    if (!ring.is_closed && (std::abs(total - half) > corner_angle || ring.vertices.size() < 3)) return {};
    std::vector<Vector2d> places;
    std::vector<std::array<int, 2>> sides;
    const auto count = static_cast<int>(ring.vertices.size());
    double angle = 0;
    for (int k = 0; k < count; ++k) {
      const double distance = (place(ring.vertices[k]) - place(v)).norm();
      places.emplace_back(distance * std::cos(angle), distance * std::sin(angle));
      sides.push_back({k, (k + 1) % count});
      if (k < std::ssize(ring.angles)) angle += ring.angles[k] * whole / total;
      if (k < std::ssize(ring.angles) && ring.angles[k] * whole / total > 0.95 * half) return {};
    }
    double before = smallest_angle;
    Vector3d normal(0, 0, 0);
    for (const int t : around_[v]) {
      before = std::min(before, least_angle(triangles_[t]));
      normal += area_vector(triangles_[t]);
    }
    std::vector<Corners> made;
    const Triangles triangles = triangles_within(places, sides);
    for (const auto& t : triangles.rowwise()) {
      const Corners corners{ring.vertices[t[0]], ring.vertices[t[1]], ring.vertices[t[2]]};
      if (least_angle(corners) < before || angle_between(area_vector(corners), normal) > most_turned)
        return {};
      for (int k = 0; k < 3; ++k) {
        const int from = t[k], to = t[(k + 1) % 3];
        const bool is_old = (from + 1) % count == to && (ring.is_closed || to != 0);
        if (!is_old && are_joined(ring.vertices[from], ring.vertices[to])) return {};
      }
      made.push_back(corners);
    }
    const auto wanted = static_cast<std::size_t>(count - 2);
    if (made.size() != wanted || (wanted == 1 && ring.is_closed && is_triangle(made.front()))) return {};
    return made;
  }

  bool are_joined(int a, int b) const {
    return std::ranges::any_of(
        around_[a], [&](int t) { return std::ranges::find(triangles_[t], b) != triangles_[t].end(); });
  }
  bool is_triangle(const Corners& c) const {
    return std::ranges::any_of(around_[c[0]],
                               [&](int t) { return std::ranges::is_permutation(triangles_[t], c); });
  }

  bool remove(int v) {
    const std::optional<Ring> ring = ring_of(v);
    if (!ring) return false;
    const auto made = filling(v, *ring);
    if (!made) return false;
    std::vector<int> lost = {v};
    const std::vector<int> old = around_[v];
    for (const int t : old) {
      lost.insert(lost.end(), lost_[t].begin(), lost_[t].end());
      lost_[t].clear();
      drop(t);
    }
    std::vector<int> added;
    for (const Corners& corners : *made) added.push_back(add(corners));
    Triangles within(static_cast<Eigen::Index>(made->size()), 3);
    for (std::size_t k = 0; k < made->size(); ++k)
      for (int c = 0; c < 3; ++c) within(static_cast<Eigen::Index>(k), c) = (*made)[k][c];
    for (const int w : lost) {
      EmbeddedPoint nearest;
      for (int k = 0; k < std::ssize(added); ++k) take_nearer(nearest, w, within, k);
      lost_[added[nearest.triangle]].push_back(w);
    }
    for (const int w : ring->vertices) offer(w);
    return true;
  }

  void take_nearer(EmbeddedPoint& nearest, int v, const Triangles& triangles, int t) const {
    const EmbeddedPoint own = EmbeddedPoint::of(place(v), fine_.rest.vertices, triangles, t);
    if (own.distance < nearest.distance) nearest = own;
  }

  const Level& fine_;
  std::vector<Corners> triangles_;
  std::vector<char> alive_;             // of each triangle
  std::vector<std::vector<int>> lost_;  // vertices that rest on each triangle
  std::vector<std::vector<int>> around_;
  Eigen::VectorXd spacing_;  // mean area of the fine triangles around each vertex [m²]
  std::set<std::pair<double, int>> offered_;
  std::vector<double> cost_;  // as offered; -1: is not
  int left_;
};

}  // namespace

CoarseSurface CoarseSurface::of(const Level& fine, double ratio) {
  ShrinkingMesh mesh(fine);
  mesh.shrink(static_cast<int>(std::lround(fine.vertex_count() / ratio)));
  return mesh.surface();
}

}  // namespace drape
