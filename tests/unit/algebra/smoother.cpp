#include "core/numerics/multigrid/smoother.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

using namespace drape;

namespace {

/// A symmetric, diagonally dominant matrix whose rows have blocks in their own piece and in others.
struct PiecewiseMatrix {
  static constexpr int n = SmoothedMatrix::piece + 904, far = 2500;
  SmoothedMatrix matrix;
  std::mt19937 random{1};

  static float entry(int i, int j, int r, int c) {
    if (i > j || (i == j && r > c)) return entry(j, i, c, r);
    const float e = 0.2F * std::sin(static_cast<float>(13 * i + 7 * j + 3 * r + c));
    return i == j && r == c ? 5 : e;
  }

  PiecewiseMatrix() {
    std::vector<int> start = {0}, columns;
    for (int i = 0; i < n; ++i) {
      for (const int j : {i - far, i - 7, i - 1, i, i + 1, i + 7, i + far})
        if (j >= 0 && j < n) columns.push_back(j);
      start.push_back(static_cast<int>(columns.size()));
    }
    matrix.set_pattern({start, columns});
    each_entry([&](int i, int j, int k, int r, int c) { matrix.block(k)[3 * c + r] = entry(i, j, r, c); });
    REQUIRE(matrix.finish());
  }
  /// Calls `visit` with the row, the column and the number of each block, and row and column in it.
  template <class Visit>
  void each_entry(const Visit& visit) const {
    for (int i = 0; i < n; ++i)
      for (int k = matrix.pattern().start[i]; k < matrix.pattern().start[i + 1]; ++k)
        for (int e = 0; e < 9; ++e) visit(i, matrix.pattern().items[k], k, e / 3, e % 3);
  }
  std::vector<Float4> vectors() {
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<Float4> b(n);
    for (Float4& v : b) v = Float4{uniform(random), uniform(random), uniform(random), 0};
    return b;
  }
  /// A sweep forwards and one backwards.
  std::vector<Float4> smoothed(const std::vector<Float4>& b) const {
    std::vector<Float4> x(n), r(n), old(n);
    matrix.presmooth(b, x, r);
    matrix.postsmooth(b, x, old);
    return x;
  }
};

double inner(const std::vector<Float4>& a, const std::vector<Float4>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int c = 0; c < 3; ++c) sum += static_cast<double>(a[i][c]) * b[i][c];
  return sum;
}

}  // namespace

TEST_CASE("A forward sweep leaves the residual of what it found") {
  PiecewiseMatrix e;
  const std::vector<Float4> b = e.vectors();
  std::vector<Float4> x(PiecewiseMatrix::n), r(PiecewiseMatrix::n);
  e.matrix.presmooth(b, x, r);
  std::vector<double> expected;
  for (const Float4& v : b) expected.insert(expected.end(), {v[0], v[1], v[2]});
  e.each_entry([&](int i, int j, int, int row, int c) {
    expected[3 * i + row] -= double{PiecewiseMatrix::entry(i, j, row, c)} * x[j][c];
  });
  for (int k = 0; k < 3 * PiecewiseMatrix::n; ++k)
    REQUIRE(r[k / 3][k % 3] == Approx(expected[k]).margin(1e-5));
  CHECK(inner(r, r) > 0.01);
  CHECK(inner(r, r) < 0.5 * inner(b, b));
}

TEST_CASE("A forward and a backward sweep are a symmetric preconditioner, of definite blocks alone") {
  PiecewiseMatrix e;
  const std::vector<Float4> a = e.vectors();
  std::vector<Float4> b = e.vectors();
  for (std::size_t i = 0; i < b.size(); ++i) b[i] += a[i];
  const double ab = inner(a, e.smoothed(b));
  CHECK(std::abs(ab) > 1);
  CHECK(inner(b, e.smoothed(a)) == Approx(ab).epsilon(1e-5));
  CHECK(inner(a, e.smoothed(a)) > 0);
  // A block of a vertex that is not positive definite is refused.
  e.each_entry([&](int i, int j, int k, int, int) {
    if (i == 4500 && j == i) e.matrix.block(k)[4] = -1;
  });
  CHECK_FALSE(e.matrix.finish());
}
