#include "plugins/contact/shapes/shape_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/collision_detection/closest.h"

namespace drape::shapes {

namespace {

using Eigen::Vector3d;

constexpr int grain = 2048;   // triangles per task
constexpr double half = 0.5;  // weight factor of pairs of edges and of pairs with a triangle

/// A bounding ball of an element's linear motion.
struct Ball {
  Vector3d centre;
  double radius;
};

Ball ball_of(const int* vertices, int count, const Positions& x0, const Positions& x1) {
  Ball ball{Vector3d::Zero(), 0};
  for (int k = 0; k < count; ++k) ball.centre += (x0.row(vertices[k]) + x1.row(vertices[k])).transpose();
  ball.centre /= 2 * count;
  for (int k = 0; k < count; ++k)
    for (const Positions* x : {&x0, &x1})
      ball.radius = std::max(ball.radius, (x->row(vertices[k]).transpose() - ball.centre).norm());
  return ball;
}

/// Below the distance of any ball in the box from the solid [m], since distances grow no faster than lengths.
double distance_bound(const Solid& solid, const Box& box) {
  constexpr double rounding = 1e-6;
  return solid.distance(box.centre()) - (1 + rounding) * box.radius();
}

/// Searches the candidates of one solid.
class Finder {
 public:
  Finder(const ShapeScene& scene, int solid, const Positions& x0, const Positions& x1)
      : scene_(scene),
        solid_index_(solid),
        solid_(scene.solids[solid]),
        cloth_size_(static_cast<int>(x0.rows())),
        x0_(x0),
        x1_(x1) {}

  /// Which of the triangles `among` may come within d̂, ascending.
  std::vector<int> triangles_near(const std::vector<int>& among) const {
    const auto test = [&](int begin, int end, std::vector<int>& near) {
      for (int i = begin; i < end; ++i)
        if (is_near(ball_of(&scene_.cloth.triangles(among[i], 0), 3, x0_, x1_))) near.push_back(among[i]);
    };
    return parallel_collect<int>(static_cast<int>(among.size()), grain, test);
  }

  /// Which of all triangles may come within d̂, found in a tree of their boxes.
  std::vector<int> triangles_near(const BoxTree& all) const {
    std::vector<int> near;
    all.visit_near(
        scene_.barrier.dhat, [&](const Box& box) { return distance_bound(solid_, box); },
        [&](int i) {
          if (is_near(ball_of(&scene_.cloth.triangles(i, 0), 3, x0_, x1_))) near.push_back(i);
          return scene_.barrier.dhat;
        });
    std::ranges::sort(near);
    return near;
  }

  std::vector<int> vertices_of(const std::vector<int>& triangles) const {
    return elements_near(triangles, scene_.cloth.triangles,
                         [&](int i) { return is_near(ball_of(&i, 1, x0_, x1_)); });
  }
  std::vector<int> edges_of(const std::vector<int>& triangles) const {
    return elements_near(triangles, scene_.cloth.triangle_edges,
                         [&](int i) { return is_near(ball_of(&scene_.cloth.edges(i, 0), 2, x0_, x1_)); });
  }

  /// Which of the triangles may come within the d̂ of rims, smaller than the scene's.
  std::vector<int> triangles_near_rims(const Features& rims, std::vector<int> triangles) const {
    std::erase_if(triangles, [&](int i) {
      const int* vertices = &scene_.cloth.triangles(i, 0);
      const Ball ball = ball_of(vertices, 3, x0_, x1_);
      return rims.distance_bound(solid_, ball.centre) > ball.radius + rims.dhat ||
             separate(solid_, scene_.corners(i, x0_)).separation > reach_of(rims, vertices, 3);
    });
    return triangles;
  }

  /// Adds pairs of the points and triangles.
  void add_point_triangle(const Features& features, const std::vector<int>& triangles,
                          std::vector<ContactPair>& pairs) const {
    const double share = features.edges.empty() ? 1 : half;  // a sphere has no other pairs
    std::vector<int> found;
    for (const int i : triangles) {
      const Ball ball = ball_of(&scene_.cloth.triangles(i, 0), 3, x0_, x1_);
      found.clear();
      features.points_near(solid_, ball.centre, ball.radius + features.reach(), found);
      if (features.sides > 0) drop_far_points(features, i, found);
      const double area = scene_.cloth.triangle_area[i];
      ContactPair pair = pair_of(features, PairKind::point_triangle,
                                 share * area * side_fraction(features, std::sqrt(2 * area)));
      for (const int point : found) {
        pair.vertices = {vertex_of(features, point), scene_.cloth.triangles(i, 0),
                         scene_.cloth.triangles(i, 1), scene_.cloth.triangles(i, 2)};
        pairs.push_back(pair);
      }
    }
  }

  /// Adds pairs of the features' and the cloth's edges.
  void add_edge_edge(const Features& features, const std::vector<int>& edges,
                     std::vector<ContactPair>& pairs) const {
    std::vector<int> found;
    for (const int i : edges) {
      const Ball ball = ball_of(&scene_.cloth.edges(i, 0), 2, x0_, x1_);
      found.clear();
      features.edges_near(solid_, ball.centre, ball.radius + features.reach(), found);
      if (features.sides > 0) drop_far_sides(features, i, found);
      const double length = std::sqrt(scene_.cloth.edge_length_squared[i]);
      ContactPair pair = pair_of(features, PairKind::edge_edge,
                                 half * scene_.cloth.edge_area[i] * side_fraction(features, length));
      for (const int edge : found) {
        const auto [a, b] = features.edges[edge];
        pair.vertices = {scene_.cloth.edges(i, 0), scene_.cloth.edges(i, 1), vertex_of(features, a),
                         vertex_of(features, b)};
        pair.mollifier =
            mollifier_threshold * length * length * (features.points[b] - features.points[a]).squaredNorm();
        pairs.push_back(pair);
      }
    }
  }

  /// Adds pairs of a cylinder's axis and the cloth's edges.
  void add_curved_side(const Features& axis, const std::vector<int>& edges,
                       std::vector<ContactPair>& pairs) const {
    const double length_squared = (axis.points[1] - axis.points[0]).squaredNorm();
    for (const int i : edges) {
      ContactPair pair = pair_of(axis, PairKind::edge_edge, half * scene_.cloth.edge_area[i]);
      pair.mollifier = mollifier_threshold * scene_.cloth.edge_length_squared[i] * length_squared;
      pair.vertices = {vertex_of(axis, 0), vertex_of(axis, 1), scene_.cloth.edges(i, 0),
                       scene_.cloth.edges(i, 1)};
      pairs.push_back(pair);
    }
  }

 private:
  /// The distance at x0 within which an element may come within the rims' d̂.
  double reach_of(const Features& rims, const int* vertices, int count) const {
    double moved = 0;
    for (int k = 0; k < count; ++k)
      moved = std::max(moved, (x1_.row(vertices[k]) - x0_.row(vertices[k])).norm());
    return moved + rims.dhat;
  }
  /// A ball around a triangle or an edge holds many sides of a rim, of which few are near the element. These
  /// drop points too far from the triangle's plane, and sides too far from the edge.
  void drop_far_points(const Features& rims, int triangle, std::vector<int>& points) const {
    const Corners c = scene_.corners(triangle, x0_);
    const Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
    const double reach = reach_of(rims, &scene_.cloth.triangles(triangle, 0), 3);
    std::erase_if(points, [&](int i) { return std::abs(normal.dot(rims.points[i] - c[0])) > reach; });
  }
  void drop_far_sides(const Features& rims, int edge, std::vector<int>& sides) const {
    const int* vertices = &scene_.cloth.edges(edge, 0);
    const Vector3d a = x0_.row(vertices[0]), u = x0_.row(vertices[1]).transpose() - a;
    const double reach = reach_of(rims, vertices, 2) + 0.5 * rims.side;
    std::erase_if(sides, [&](int i) {
      const Vector3d middle = 0.5 * (rims.points[rims.edges[i][0]] + rims.points[rims.edges[i][1]]) - a;
      return (middle - nearest_on_segment(u, middle) * u).norm() > reach;
    });
  }
  /// A pair with one of the features, without its vertices.
  ContactPair pair_of(const Features& features, PairKind kind, double weight) const {
    ContactPair pair{{}, kind, solid_index_, weight, features.dhat, features.offset};
    pair.friction = solid_.friction;
    return pair;
  }
  /// The index of a feature's point in pairs.
  int vertex_of(const Features& features, int point) const {
    return cloth_size_ + features.first_point + point;
  }
  bool is_near(const Ball& ball) const {
    return solid_.distance(ball.centre) - ball.radius < scene_.barrier.dhat;
  }
  /// The fraction of a cloth element of this length that one side of a rim's polygon covers. The sides
  /// of a rim that is thinner than the element share it.
  static double side_fraction(const Features& features, double length) {
    if (features.sides == 0) return 1;
    return std::clamp(features.side / length, 1.0 / features.sides, 1.0);
  }

  /// The triangles' vertices or edges that are near; ascending, each once.
  template <class IsNear>
  static std::vector<int> elements_near(const std::vector<int>& triangles, const Triangles& corners,
                                        const IsNear& is_near) {
    std::vector<int> result;
    for (const int i : triangles)
      for (int k = 0; k < 3; ++k) result.push_back(corners(i, k));
    std::ranges::sort(result);
    result.erase(std::unique(result.begin(), result.end()), result.end());
    std::erase_if(result, [&](int i) { return !is_near(i); });
    return result;
  }

  const ShapeScene& scene_;
  int solid_index_;
  const Solid& solid_;
  int cloth_size_;
  const Positions &x0_, &x1_;
};

}  // namespace

ShapeScene ShapeScene::of(const Level& level, const std::vector<Solid>& solids,
                          std::shared_ptr<const SolidFeatures> features, const BarrierParameters& barrier,
                          double min_gap_fraction) {
  ShapeScene s;
  s.cloth = Surface::of(level.rest, level.topology);
  s.vertex_area = level.vertex_area;
  s.diagonal = bounding_box_diagonal(level.rest.vertices);
  s.solids = solids;
  s.features = std::move(features);
  s.barrier = barrier;
  s.min_gap_fraction = min_gap_fraction;
  return s;
}

BoxTree tree_of_triangles(const ShapeScene& scene, const Positions& x0, const Positions& x1) {
  std::vector<Box> boxes(scene.cloth.triangles.rows());
  parallel_for(static_cast<int>(boxes.size()), grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Ball ball = ball_of(&scene.cloth.triangles(i, 0), 3, x0, x1);
      boxes[i] = Box::around(ball.centre, ball.centre, ball.radius);
    }
  });
  BoxTree tree;
  tree.build(boxes);
  return tree;
}

std::vector<SolidPair> find_triangles(const ShapeScene& scene, const Positions& x0, const Positions& x1) {
  constexpr int few = 8;  // for which a tree does not pay
  const int solids = static_cast<int>(scene.solids.size());
  std::vector<SolidPair> found;
  std::vector<int> all(scene.cloth.triangles.rows());
  std::iota(all.begin(), all.end(), 0);
  const BoxTree tree = solids > few ? tree_of_triangles(scene, x0, x1) : BoxTree();
  for (int k = 0; k < solids; ++k) {
    const Finder finder(scene, k, x0, x1);
    for (const int i : solids > few ? finder.triangles_near(tree) : finder.triangles_near(all))
      found.push_back({i, k});
  }
  return found;
}

SeparatingPlane nearest_triangle(const ShapeScene& scene, const Solid& solid, const BoxTree& triangles,
                                 const Positions& x) {
  SeparatingPlane nearest{Vector3d::UnitZ(), std::numeric_limits<double>::infinity()};
  triangles.visit_near(
      nearest.separation, [&](const Box& box) { return distance_bound(solid, box); },
      [&](int t) {
        const SeparatingPlane plane = separate(solid, scene.corners(t, x));
        if (plane.separation < nearest.separation) nearest = plane;
        return nearest.separation;
      });
  return nearest;
}

CandidatePairs find_candidates(const ShapeScene& scene, const std::vector<SolidPair>& found,
                               const Positions& x0, const Positions& x1) {
  CandidatePairs c;
  std::size_t next = 0;
  for (int k = 0; k < static_cast<int>(scene.solids.size()); ++k) {
    const Finder finder(scene, k, x0, x1);
    std::vector<int> triangles;
    for (; next < found.size() && found[next].solid == k; ++next) triangles.push_back(found[next].element);
    triangles = finder.triangles_near(triangles);
    if (scene.solids[k].kind != SolidKind::sphere)
      for (const int i : finder.vertices_of(triangles)) c.vertices.push_back({i, k});
    const auto has_edges = [](const Features& f) { return !f.edges.empty(); };
    std::vector<int> edges;
    const std::vector<Features>& of_solid = scene.features->of_solid[k];
    if (std::ranges::any_of(of_solid, has_edges)) edges = finder.edges_of(triangles);
    for (const Features& features : of_solid) {
      if (features.is_axis) {
        finder.add_curved_side(features, edges, c.curved_sides);
        continue;
      }
      if (features.dhat < scene.barrier.dhat) {  // rims of many sides, which come last
        triangles = finder.triangles_near_rims(features, std::move(triangles));
        edges = finder.edges_of(triangles);
      }
      finder.add_point_triangle(features, triangles, c.pairs);
      finder.add_edge_edge(features, edges, c.pairs);
    }
  }
  return c;
}

}  // namespace drape::shapes
