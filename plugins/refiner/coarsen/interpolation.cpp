#include "plugins/refiner/coarsen/interpolation.h"

#include <algorithm>
#include <limits>

#include "core/numerics/patterns/plane_grid.h"

namespace drape {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// A coarse triangle in the plane of its piece.
struct FlatTriangle {
  Vector2d a, b, c;

  Vector3d weights(const Vector2d& p) const {
    const double area = cross(b - a, c - a), v = cross(p - a, c - a) / area, w = cross(b - a, p - a) / area;
    return {1 - v - w, v, w};
  }
  /// How far p with these weights is outside, about [m]; negative inside.
  double outside(const Vector3d& weights) const {
    const double area = cross(b - a, c - a);
    const Vector3d sides((c - b).norm(), (a - c).norm(), (b - a).norm());
    return -(weights.array() * area / sides.array()).minCoeff();
  }
};

/// The coarse triangles of one piece, to be found by places.
class PieceTriangles {
 public:
  PieceTriangles(const FlatCloth& flat, const CoarsePieces& pieces, int piece)
      : flat_(flat),
        pieces_(pieces),
        first_(pieces.first[piece]),
        end_(pieces.first[piece + 1]),
        grid_(grid()) {
    for (int t = first_; t < end_; ++t) {
      const FlatTriangle own = at(t);
      grid_.add(t, own.a.cwiseMin(own.b).cwiseMin(own.c), own.a.cwiseMax(own.b).cwiseMax(own.c));
    }
  }

  FlatTriangle at(int t) const {
    const auto place = [&](int k) { return flat_.images[pieces_.triangles(t, k)].place; };
    return {place(0), place(1), place(2)};
  }

  /// The triangle that holds p, or else the nearest.
  int holding(const Vector2d& p) const {
    int best = -1;
    double smallest = std::numeric_limits<double>::infinity();
    const auto consider = [&](int t) {
      const FlatTriangle own = at(t);
      const double outside = own.outside(own.weights(p));
      if (outside < smallest || (outside == smallest && t < best)) smallest = outside, best = t;
    };
    grid_.for_each(p, p, consider);
    constexpr double touching = 1e-9;  // of a triangle's size
    if (smallest > touching * grid_.cell())
      for (int t = first_; t < end_; ++t) consider(t);
    return best;
  }

 private:
  PlaneGrid grid() const {
    Vector2d lower = at(first_).a, upper = lower;
    double area = 0;
    for (int t = first_; t < end_; ++t) {
      const FlatTriangle own = at(t);
      lower = lower.cwiseMin(own.a).cwiseMin(own.b).cwiseMin(own.c);
      upper = upper.cwiseMax(own.a).cwiseMax(own.b).cwiseMax(own.c);
      area += cross(own.b - own.a, own.c - own.a);
    }
    return {lower, upper, std::sqrt(area / (end_ - first_))};
  }

  const FlatCloth& flat_;
  const CoarsePieces& pieces_;
  int first_, end_;
  PlaneGrid grid_;
};

}  // namespace

ProlongationMatrix flat_interpolation(const FlatCloth& flat, const CoarsePieces& pieces,
                                      const std::vector<int>& coarse, int coarse_count) {
  constexpr double rounding = 1e-12;  // a smaller weight is none
  std::vector<PieceTriangles> triangles;
  for (int p = 0; p < flat.piece_count; ++p) triangles.emplace_back(flat, pieces, p);
  const auto n = static_cast<int>(flat.on_outline.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < n; ++v) {
    if (pieces.kept[v]) {
      entries.emplace_back(v, coarse[v], 1);
      continue;
    }
    const auto images = flat.of_vertex.row(v);
    for (const int i : images) {
      const PieceTriangles& own = triangles[flat.images[i].piece];
      const int t = own.holding(flat.images[i].place);
      Vector3d weights = own.at(t).weights(flat.images[i].place);
      for (double& w : weights)
        if (std::abs(w) < rounding) w = 0;
      weights /= weights.sum() * static_cast<double>(images.size());
      for (int k = 0; k < 3; ++k)
        if (weights[k] != 0)
          entries.emplace_back(v, coarse[flat.images[pieces.triangles(t, k)].vertex], weights[k]);
    }
  }
  ProlongationMatrix matrix(n, coarse_count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace drape
