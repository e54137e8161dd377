#include "core/numerics/dressing/garment_rest.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/numerics/elements/stretch.h"

namespace drape {

namespace {

using Matrix2 = Eigen::Matrix2d;

/// The positive definite root of a positive definite matrix.
Matrix2 root_of(const Matrix2& m) {
  const double area = std::sqrt(m.determinant());
  return (m + area * Matrix2::Identity()) / std::sqrt(m.trace() + 2 * area);
}

}  // namespace

Level with_intermediate_rest(const Level& flat, const Positions& placed, double weight) {
  Level level = flat;
  const TriangleMesh& mesh = flat.rest;
  for (int t = 0; t < flat.triangle_count(); ++t) {
    const Eigen::Matrix3d corners = rest_corners(mesh, t);
    Matrix2 own;  // edges of the piece, one a column
    Eigen::Matrix<double, 3, 2> edges;
    for (int k = 0; k < 2; ++k) {
      own.col(k) = (corners.col(k + 1) - corners.col(0)).head<2>();
      edges.col(k) = (placed.row(mesh.triangles(t, k + 1)) - placed.row(mesh.triangles(t, 0))).transpose();
    }
    const Matrix2 inverse = own.inverse();
    const Eigen::Matrix<double, 3, 2> stretch = edges * inverse;
    const Matrix2 mean = weight * stretch.transpose() * stretch + (1 - weight) * Matrix2::Identity();
    const Matrix2 rest = root_of(mean) * own / mesh.sewing->uv_length;
    for (int k = 0; k < 2; ++k)
      level.rest.uv.block<1, 2>(t, 2 * (k + 1)) = mesh.uv.block<1, 2>(t, 0) + rest.col(k).transpose();
  }
  return level;
}

Tightness tightest_piece(const Level& level, const Positions& x) {
  constexpr double share = 0.1;
  struct Stretched {
    double stretch, area;
    int triangle;
  };
  std::vector<std::vector<Stretched>> pieces(level.rest.piece_names.size());
  for (int t = 0; t < level.triangle_count(); ++t) {
    const auto v = level.rest.triangles.row(t);
    const RestTriangle rest = RestTriangle::of(level, t);
    const double largest = rest.stretch(x.row(v[1]) - x.row(v[0]), x.row(v[2]) - x.row(v[0])).largest;
    pieces[level.rest.piece[t]].push_back({largest - 1, rest.area, t});
  }
  Tightness tightest{0, -1, 0};
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    std::ranges::stable_sort(pieces[p], std::greater(), &Stretched::stretch);
    double whole = 0, passed = 0;
    for (const Stretched& s : pieces[p]) whole += s.area;
    for (const Stretched& s : pieces[p]) {
      passed += s.area;
      if (passed < share * whole) continue;
      if (s.stretch > tightest.stretch) tightest = {static_cast<int>(p), s.stretch, pieces[p][0].triangle};
      break;
    }
  }
  return tightest;
}

}  // namespace drape
