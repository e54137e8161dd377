#include <Eigen/Geometry>
#include <algorithm>
#include <span>
#include <tuple>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/contact/pair_geometry.h"
#include "core/numerics/contact/surface_contacts.h"

namespace drape {
namespace {

using Eigen::Vector3d;

constexpr int vertices_per_task = 1024;

/// Sums of coefficients below this are round-off of terms that cancel.
constexpr double zero_coefficient = 1e-12;

/// Evaluates the improved maximum operator (Li et al. 2023) for points near the obstacles' surface. Terms
/// with the same nearest feature are added before the barrier is evaluated, and most cancel.
class FeatureSearch {
 public:
  FeatureSearch(const ObstacleSurface& obstacles, const Dihedrals& dihedrals,
                const Eigen::VectorXd& vertex_area, double friction, double dhat)
      : obstacles_(obstacles),
        dihedrals_(dihedrals),
        vertex_area_(vertex_area),
        friction_(friction),
        dhat_(dhat) {}

  /// The features within d̂ of a cloth vertex at p that have a non-zero coefficient. `candidates` are all
  /// triangles that may be within d̂ of it.
  std::vector<NearestFeature> find(const Vector3d& p, std::span<const VertexTriangleCandidate> candidates) {
    std::vector<NearestFeature> features;
    terms_.clear();
    near_.clear();
    for (const VertexTriangleCandidate& candidate : candidates) add_triangle(p, candidate.triangle);
    // If an edge or vertex is within d̂, so are all of its triangles, including its representative.
    if (near_.size() > 1)
      for (const int t : near_)
        for (int k = 0; k < 3; ++k) {
          if (obstacles_.topology->represents_edge(t, k))
            add_edge(p, obstacles_.topology->triangle_edges(t, k));
          if (obstacles_.topology->represents_vertex(t, k))
            add_vertex(p, obstacles_.topology->triangles(t, k));
        }
    std::ranges::sort(terms_, {}, [](const Term& term) { return std::tuple(term.kind, term.index); });
    for (std::size_t i = 0; i < terms_.size();) {
      Term sum = terms_[i];
      for (++i; i < terms_.size() && terms_[i].kind == sum.kind && terms_[i].index == sum.index; ++i)
        sum.coefficient += terms_[i].coefficient;
      if (std::abs(sum.coefficient) > zero_coefficient)
        features.push_back(feature(p, sum, vertex_area_[candidates.front().vertex]));
    }
    return features;
  }

 private:
  enum class Kind { face, edge, vertex };
  struct Term {
    Kind kind;
    int index;
    double coefficient;
  };

  void add_triangle(const Vector3d& p, int t) {
    const auto v = obstacles_.topology->triangles.row(t);
    PairPositions x;
    x << p, position(v[0]), position(v[1]), position(v[2]);
    if (box_distance(PairKind::point_triangle, x) >= dhat_) return;
    const Closest found = closest(PairKind::point_triangle, x);
    if (connection(x, found).squaredNorm() >= dhat_ * dhat_) return;
    near_.push_back(t);
    const auto is_in = [&](int k) { return found.c[1 + k] != 0; };
    if (found.free == 2) {
      terms_.push_back({Kind::face, t, 1});
    } else if (found.free == 1) {
      const int opposite = !is_in(0) ? 0 : !is_in(1) ? 1 : 2;
      terms_.push_back({Kind::edge, obstacles_.topology->triangle_edges(t, opposite), 1});
    } else {
      terms_.push_back({Kind::vertex, v[is_in(0) ? 0 : is_in(1) ? 1 : 2], 1});
    }
  }

  void add_edge(const Vector3d& p, int e) {
    const double coefficient = dihedrals_.edge_coefficient(e, dhat_);
    if (coefficient == 0) return;
    const auto v = obstacles_.topology->edges.row(e);
    const Vector3d a = position(v[0]), b = position(v[1]);
    const double t = nearest_on_segment(b - a, p - a);
    if ((p - a - t * (b - a)).squaredNorm() >= dhat_ * dhat_) return;
    if (t > 0 && t < 1)
      terms_.push_back({Kind::edge, e, -coefficient});
    else
      terms_.push_back({Kind::vertex, v[t > 0], -coefficient});
  }

  void add_vertex(const Vector3d& p, int v) {
    if ((p - position(v)).squaredNorm() >= dhat_ * dhat_) return;
    if (const double coefficient = dihedrals_.vertex_coefficient(v, dhat_); coefficient != 0)
      terms_.push_back({Kind::vertex, v, coefficient});
  }

  NearestFeature feature(const Vector3d& p, const Term& term, double area) const {
    const SurfaceTopology& surface = *obstacles_.topology;
    NearestFeature f;
    f.vertices = {-1, -1, -1};
    f.weights = Vector3d::UnitX();
    f.along.setZero();
    f.coefficient = term.coefficient;
    f.area = area;
    if (term.kind == Kind::face) {
      for (int k = 0; k < 3; ++k) f.vertices[k] = surface.triangles(term.index, k);
      const Vector3d a = position(f.vertices[0]), b = position(f.vertices[1]), c = position(f.vertices[2]);
      f.weights = -closest_point_triangle(p, a, b, c).c.tail<3>();
      // The plane's normal is accurate even if the gap is small compared with the triangle; p minus the
      // nearest point is not.
      f.normal = (b - a).cross(c - a).normalized();
      f.distance = f.normal.dot(p - a);
      if (f.distance < 0) {
        f.distance = -f.distance;
        f.normal = -f.normal;
      }
    } else if (term.kind == Kind::edge) {
      for (int k = 0; k < 2; ++k) f.vertices[k] = surface.edges(term.index, k);
      const Vector3d a = position(f.vertices[0]), b = position(f.vertices[1]);
      const double t = nearest_on_segment(b - a, p - a);
      f.weights = {1 - t, t, 0};
      f.along = (b - a).normalized();
      Vector3d r = p - a;
      r -= f.along.dot(r) * f.along;
      r -= f.along.dot(r) * f.along;
      f.distance = r.norm();
      f.normal = r / f.distance;
    } else {
      f.vertices[0] = term.index;
      const Vector3d r = p - position(term.index);
      f.distance = r.norm();
      f.normal = r / f.distance;
    }
    f.body = obstacles_.body_of(f.vertices[0]);
    f.friction = obstacles_.friction_of(f.body, friction_);
    return f;
  }

  Vector3d position(int v) const { return obstacles_.vertices.row(v); }

  const ObstacleSurface& obstacles_;
  const Dihedrals& dihedrals_;
  const Eigen::VectorXd& vertex_area_;
  double friction_, dhat_;
  std::vector<Term> terms_;
  std::vector<int> near_;  // triangles within d̂
};

}  // namespace

std::vector<SurfaceContact> find_surface_contacts(const Positions& x, const ObstacleSurface& obstacles,
                                                  const Dihedrals& dihedrals,
                                                  const std::vector<VertexTriangleCandidate>& candidates,
                                                  const Eigen::VectorXd& vertex_area, double friction,
                                                  double dhat) {
  std::vector<std::span<const VertexTriangleCandidate>> of_vertices;
  for (auto begin = candidates.begin(), end = begin; begin != candidates.end(); begin = end) {
    end = std::find_if(begin, candidates.end(), [&](const auto& c) { return c.vertex != begin->vertex; });
    of_vertices.emplace_back(begin, end);
  }
  const auto find = [&](int begin, int end, std::vector<SurfaceContact>& found) {
    FeatureSearch search(obstacles, dihedrals, vertex_area, friction, dhat);
    for (int k = begin; k < end; ++k) {
      const int vertex = of_vertices[k].front().vertex;
      std::vector<NearestFeature> features = search.find(x.row(vertex), of_vertices[k]);
      if (!features.empty()) found.push_back({vertex, std::move(features)});
    }
  };
  return parallel_collect<SurfaceContact>(static_cast<int>(of_vertices.size()), vertices_per_task, find);
}

}  // namespace drape
