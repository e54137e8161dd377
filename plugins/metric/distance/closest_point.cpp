#include "plugins/metric/distance/closest_point.h"

#include <algorithm>
#include <numeric>

namespace drape {
namespace {

using Eigen::Vector3d;

double squared_point_segment_distance(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d edge = b - a;
  const double length2 = edge.squaredNorm();
  const double s = length2 > 0 ? std::clamp(edge.dot(p - a) / length2, 0.0, 1.0) : 0.0;
  return (p - a - s * edge).squaredNorm();
}

}  // namespace

double squared_point_triangle_distance(const Vector3d& p, const Vector3d& a, const Vector3d& b,
                                       const Vector3d& c) {
  const Vector3d normal = (b - a).cross(c - a);
  const double length2 = normal.squaredNorm();
  const bool above = length2 > 0 && normal.dot((b - a).cross(p - a)) >= 0 &&
                     normal.dot((c - b).cross(p - b)) >= 0 && normal.dot((a - c).cross(p - c)) >= 0;
  if (above) {
    const double height = normal.dot(p - a);
    return height * height / length2;
  }
  return std::min({squared_point_segment_distance(p, a, b), squared_point_segment_distance(p, b, c),
                   squared_point_segment_distance(p, c, a)});
}

SurfaceDistance::SurfaceDistance(const Positions& x, const Triangles& triangles)
    : x_(x), triangles_(triangles), order_(triangles.rows()) {
  std::iota(order_.begin(), order_.end(), 0);
  Positions centres(triangles.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    centres.row(t) = (x.row(triangles(t, 0)) + x.row(triangles(t, 1)) + x.row(triangles(t, 2))) / 3;
  nodes_.reserve(triangles.rows());
  build(0, static_cast<int>(order_.size()), centres);
}

int SurfaceDistance::build(int begin, int end, const Positions& centres) {
  const int node = static_cast<int>(nodes_.size());
  Node made{{}, begin, end, 0};
  Eigen::AlignedBox3d centre_box;
  for (int k = begin; k < end; ++k) {
    for (const int i : triangles_.row(order_[k])) made.box.extend(Vector3d(x_.row(i).transpose()));
    centre_box.extend(Vector3d(centres.row(order_[k]).transpose()));
  }
  nodes_.push_back(made);
  constexpr int leaf_size = 4;
  if (end - begin <= leaf_size) return node;

  int axis;
  centre_box.sizes().maxCoeff(&axis);
  const int middle = (begin + end) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](int s, int t) { return centres(s, axis) < centres(t, axis); });
  build(begin, middle, centres);
  nodes_[node].right = build(middle, end, centres);
  return node;
}

double SurfaceDistance::squared(const Vector3d& p, double bound) const {
  int stack[64];  // the tree is balanced: its depth is below log2 of the number of triangles, plus one
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const int index = stack[--size];
    const Node& node = nodes_[index];
    if (node.box.squaredExteriorDistance(p) >= bound) continue;
    if (node.right == 0) {
      for (int k = node.begin; k < node.end; ++k) {
        const auto corner = triangles_.row(order_[k]);
        bound = std::min(bound, squared_point_triangle_distance(p, x_.row(corner[0]).transpose(),
                                                                x_.row(corner[1]).transpose(),
                                                                x_.row(corner[2]).transpose()));
      }
      continue;
    }
    const int left = index + 1, right = node.right;
    const bool left_first =
        nodes_[left].box.squaredExteriorDistance(p) <= nodes_[right].box.squaredExteriorDistance(p);
    stack[size++] = left_first ? right : left;
    stack[size++] = left_first ? left : right;
  }
  return bound;
}

}  // namespace drape
