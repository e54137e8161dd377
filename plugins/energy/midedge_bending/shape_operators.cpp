#include "plugins/energy/midedge_bending/shape_operators.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/numerics/elements/orthotropic_stiffness.h"
#include "core/numerics/elements/rest_hinge.h"
#include "core/numerics/mesh/grain.h"
#include "core/numerics/mesh/seams.h"

namespace drape {
namespace {

using Point = Eigen::Vector2d;

/// Inner edges' rows in Level::hinges; -1 on the border.
std::vector<int> hinge_of_edge(const Level& level) {
  std::vector<int> hinges(level.topology.edges.rows(), -1);
  for (std::size_t h = 0; h < level.hinge_edges.size(); ++h)
    hinges[level.hinge_edges[h]] = static_cast<int>(h);
  return hinges;
}

/// A point's foot on an edge (0 … 1 along it) and its distance from the edge.
struct Foot {
  double along, distance;

  explicit Foot(const RestSide& side) {
    const Eigen::Vector3d edge = side.to - side.from;
    along = edge.dot(side.corner - side.from) / edge.squaredNorm();
    distance = edge.cross(side.corner - side.from).norm() / edge.norm();
  }
};

/// Two triangles on both sides of an edge, unfolded into the plane.
struct Unfolded {
  Point from, to;     // the edge
  Point left, right;  // the triangles' other corners, seen along the edge
  double left_distance, right_distance;

  /// Jump of the slope across the edge for the piecewise linear interpolants of x²/2, xy and y²/2.
  Eigen::Vector3d slope_changes() const {
    const Point edge = to - from;
    const double left_along = edge.dot(left - from) / edge.squaredNorm(),
                 right_along = edge.dot(right - from) / edge.squaredNorm();
    return quadratics(left) / left_distance + quadratics(right) / right_distance -
           quadratics(from) * ((1 - left_along) / left_distance + (1 - right_along) / right_distance) -
           quadratics(to) * (left_along / left_distance + right_along / right_distance);
  }

  static Eigen::Vector3d quadratics(const Point& p) {
    return {p.x() * p.x() / 2, p.x() * p.y(), p.y() * p.y() / 2};
  }
};

/// The third corner of a triangle on the right of an edge in the plane.
Point right_corner(const Point& from, const Point& to, double along, double distance) {
  const Point edge = to - from;
  return from + along * edge + distance / edge.norm() * Point(edge.y(), -edge.x());
}

/// For every quadratic function, this sum over dihedral angles equals the slope at an edge's midpoint less
/// half the slope's jump there, from the left triangle to the right one.
struct Correction {
  int hinges[5];
  double weights[5];
  int size = 0;
};

class EdgeNormals {
 public:
  EdgeNormals(const Level& level, double tolerance)
      : level_(level), tolerance_(tolerance), hinges_(hinge_of_edge(level)) {}

  int hinge(int edge) const { return hinges_[edge]; }

  Correction correction(int edge) const {
    const Triangles& triangles = level_.rest.triangles;
    const Topology& topology = level_.topology;
    const int t[2] = {topology.edge_triangles(edge, 0), topology.edge_triangles(edge, 1)};
    const int c[2] = {topology.corner_opposite(edge, t[0]), topology.corner_opposite(edge, t[1])};
    const int from = triangles(t[0], (c[0] + 1) % 3), to = triangles(t[0], (c[0] + 2) % 3);

    // The edge lies on the x-axis about the origin and has length 1; triangle 0 is on its left.
    const RestSide first = rest_side(level_.rest, topology, edge, 0);
    const double length = (first.to - first.from).norm();
    Unfolded own{Point(-0.5, 0), Point(0.5, 0), {}, {}, 0, 0};
    const Foot left(first), right(rest_side(level_.rest, topology, edge, 1));
    own.left_distance = left.distance / length, own.right_distance = right.distance / length;
    own.left = {left.along - 0.5, own.left_distance};
    own.right = {right.along - 0.5, -own.right_distance};

    Correction result;
    Eigen::Matrix<double, 3, 5> changes;
    const auto add = [&](int inner_edge, const Unfolded& pair) {
      changes.col(result.size) = pair.slope_changes();
      result.hinges[result.size++] = hinges_[inner_edge];
    };
    add(edge, own);
    for (int side = 0; side < 2; ++side)
      for (int k = 1; k < 3; ++k) {  // the triangle's other edges
        const int corner = (c[side] + k) % 3, other = topology.triangle_edges(t[side], corner);
        if (hinges_[other] == -1) continue;
        const auto place = [&](int which) {
          const int v = triangles(t[side], which % 3);
          return v == from ? own.from : v == to ? own.to : side == 0 ? own.left : own.right;
        };
        const int near = topology.edge_triangles(other, 0) == t[side] ? 0 : 1;
        const RestSide own_side = rest_side(level_.rest, topology, other, near);
        RestSide beyond = rest_side(level_.rest, topology, other, 1 - near);
        if (near == 1) std::swap(beyond.from, beyond.to);  // the direction in this triangle
        const Foot foot(beyond);
        Unfolded pair{place(corner + 1), place(corner + 2), place(corner), {}, 0, foot.distance / length};
        pair.left_distance = 2 * triangle_area(t[side]) / ((own_side.to - own_side.from).norm() * length);
        pair.right = right_corner(pair.from, pair.to, foot.along, pair.right_distance);
        add(other, pair);
      }
    least_weights(own, changes.leftCols(result.size), result);
    return result;
  }

  double triangle_area(int t) const {
    const Eigen::Matrix3d x = rest_corners(level_.rest, t);
    return (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).norm() / 2;
  }

 private:
  /// The weights of smallest square sum with changes · weights = residual; none if all are small.
  template <class Changes>
  void least_weights(const Unfolded& own, const Changes& changes, Correction& result) const {
    // Slopes across the edge at its midpoint are 0 for all three functions; on triangle 0 they are these.
    const Eigen::Vector3d left_slope =
        (Unfolded::quadratics(own.left) - Unfolded::quadratics(own.from) * (0.5 - own.left.x()) -
         Unfolded::quadratics(own.to) * (0.5 + own.left.x())) /
        own.left_distance;
    const Eigen::Vector3d missing = left_slope - own.slope_changes() / 2;
    // Directions in which these angles hardly depend on curvature would need large weights.
    constexpr double smallest = 0.05 * 0.05;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(changes * changes.transpose());
    Eigen::Vector3d solution = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i)
      if (eigen.eigenvalues()[i] > smallest * eigen.eigenvalues()[2])
        solution +=
            eigen.eigenvectors().col(i) * (eigen.eigenvectors().col(i).dot(missing) / eigen.eigenvalues()[i]);
    const Eigen::VectorXd weights = changes.transpose() * solution;
    if (tolerance_ == 1 || weights.cwiseAbs().maxCoeff() <= tolerance_)
      result.size = 0;
    else
      for (int i = 0; i < result.size; ++i) result.weights[i] = weights[i];
  }

  const Level& level_;
  double tolerance_;
  std::vector<int> hinges_;
};

/// A plate's energy as k ‖(S11 + a S22, b S22, c S12)‖².
struct PlateNorm {
  double k, a, b, c;
  bool isotropic;

  explicit PlateNorm(const Material& material) : isotropic(!material.warp_bending) {
    if (isotropic) {
      const double nu = material.poisson_ratio;
      k = bending_stiffness(material), a = nu, b = std::sqrt(1 - nu * nu), c = std::sqrt(2 * (1 - nu));
    } else {
      const OrthotropicStiffness plate = plate_stiffness(material);
      k = plate.c11 / 2, a = plate.c12 / plate.c11;
      b = std::sqrt(plate.c22 / plate.c11 - a * a), c = 2 * std::sqrt(plate.c66 / plate.c11);
    }
  }
};

/// Edge k's l n nᵀ / Ā of a triangle, in the coordinates of the plate's norm about `axis`.
std::array<Eigen::Vector3d, 3> edge_directions(const Eigen::Matrix3d& x, const Eigen::Vector3d& axis,
                                               const PlateNorm& plate) {
  const Eigen::Vector3d normal = (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0));
  const Eigen::Vector3d e1 = axis.normalized(), e2 = normal.cross(e1).normalized();
  std::array<Eigen::Vector3d, 3> directions;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d edge = x.col((k + 2) % 3) - x.col((k + 1) % 3);
    const Point n(edge.dot(e2), -edge.dot(e1));  // of the edge's length
    const Eigen::Vector3d s(n.x() * n.x(), n.x() * n.y(), n.y() * n.y());
    directions[k] = Eigen::Vector3d(s[0] + plate.a * s[2], plate.b * s[2], plate.c * s[1]) /
                    (edge.norm() * normal.norm() / 2);
  }
  return directions;
}

}  // namespace

BendingFriction BendingFriction::of(const Material& material, double sliding_curvature) {
  if (material.bending_hysteresis == 0) return {};
  const double rigidity = material.mean_bending_modulus() * std::pow(material.thickness, 3) / 12;
  if (rigidity == 0)
    throw std::runtime_error("midedge_bending: \"bending_hysteresis\" needs a bending rigidity above 0");
  return {material.bending_hysteresis / 2 * std::sqrt(2 / rigidity),
          rigidity * sliding_curvature * sliding_curvature / 2};
}

ShapeOperators ShapeOperators::of(const Level& level, const Material& material, double tolerance) {
  const PlateNorm plate(material);
  const Positions warp = plate.isotropic ? Positions() : warp_directions(level.rest);
  const EdgeNormals normals(level, tolerance);
  std::vector<Correction> corrections(level.topology.edges.rows());
  for (int e = 0; e < level.topology.edges.rows(); ++e)
    if (normals.hinge(e) != -1) corrections[e] = normals.correction(e);

  Grouped<Term> terms;
  Eigen::VectorXd lone_folds = Eigen::VectorXd::Zero(level.hinges.rows());
  for (int t = 0; t < level.triangle_count(); ++t) {
    terms.start.push_back(static_cast<int>(terms.items.size()));
    const Eigen::Matrix3d x = rest_corners(level.rest, t);
    const std::array<Eigen::Vector3d, 3> directions = edge_directions(
        x, plate.isotropic ? Eigen::Vector3d(x.col(1) - x.col(0)) : Eigen::Vector3d(warp.row(t)), plate);

    // A free normal removes its component from the others.
    const double stiffness = plate.k * normals.triangle_area(t);
    Eigen::Matrix3d projection = Eigen::Matrix3d::Identity() * std::sqrt(stiffness);
    for (int i = 0; i < 3; ++i) {
      if (normals.hinge(level.topology.triangle_edges(t, i)) != -1) continue;
      const Eigen::Vector3d free = (projection * directions[i]).stableNormalized();
      projection -= free * (free.transpose() * projection).eval();
    }
    const auto add = [&](int hinge, const Eigen::Vector3d& weight) {
      for (std::size_t i = terms.start.back(); i < terms.items.size(); ++i)
        if (terms.items[i].hinge == hinge) {
          terms.items[i].weight += weight;
          return;
        }
      terms.items.push_back({hinge, weight});
    };
    for (int i = 0; i < 3; ++i) {
      const int e = level.topology.triangle_edges(t, i);
      if (normals.hinge(e) == -1) continue;
      const Eigen::Vector3d direction = projection * directions[i];
      add(normals.hinge(e), direction / 2);
      const double sign = level.topology.edge_triangles(e, 0) == t ? 1 : -1;
      const Correction& c = corrections[e];
      for (int j = 0; j < c.size; ++j) add(c.hinges[j], direction * (sign * c.weights[j]));
      const double own = 0.5 + (c.size > 0 ? sign * c.weights[0] : 0);
      lone_folds[normals.hinge(e)] += stiffness * own * own * directions[i].squaredNorm();
    }
  }
  terms.start.push_back(static_cast<int>(terms.items.size()));
  for (Term& term : terms.items) term.weight *= std::sqrt(stiffness_factor(level, term.hinge));
  for (Eigen::Index h = 0; h < lone_folds.size(); ++h) lone_folds[h] *= stiffness_factor(level, h);
  return {std::move(terms), std::move(lone_folds)};
}

}  // namespace drape
