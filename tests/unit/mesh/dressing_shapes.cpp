// Bodies that contract, starts that are smoothed and untangled, and rest shapes between two.

#include "core/app/scene/scene.h"
#include "core/numerics/collision_detection/intersections.h"
#include "core/numerics/dressing/garment_rest.h"
#include "core/numerics/dressing/implicit_smoothing.h"
#include "core/numerics/dressing/untangling.h"
#include "core/numerics/elements/stretch.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/sewn.h"

using namespace drape;

TEST_CASE("A sphere contracts by mean curvature flow as its curvature says, in any unit") {
  // L x = 2 x / r² M x on a sphere of radius r, so that one implicit step makes r / (1 + 2 t / r²) of it.
  for (const double unit : {1.0, 100.0}) {
    TriangleMesh sphere = unit_sphere(4);
    sphere.vertices *= 0.1 * unit;
    const double time = 0.01 * surface_area(sphere), radius = 0.1 * unit;
    CHECK(surface_area(sphere) == Approx(4 * M_PI * radius * radius).epsilon(0.01));
    const Eigen::VectorXd radii = contracted(sphere, time).rowwise().norm();
    CHECK(radii.minCoeff() == Approx(radius / (1 + 2 * time / (radius * radius))).epsilon(0.01));
    CHECK(radii.maxCoeff() == Approx(radius / (1 + 2 * time / (radius * radius))).epsilon(0.01));
  }
}

TEST_CASE("An open body contracts within its hull, and a vertex of no triangle stays") {
  TriangleMesh sheet = grid({1, 0.2}, 21, 5, Diagonals::criss_cross);
  sheet.vertices.conservativeResize(sheet.vertices.rows() + 1, 3);
  sheet.vertices.bottomRows(1) << 0.5, 0.1, 2;
  const Positions x = contracted(sheet, 0.005);
  REQUIRE(x.allFinite());
  CHECK(x.bottomRows(1).isApprox(sheet.vertices.bottomRows(1)));
  const Eigen::AlignedBox3d box = bounding_box(x.topRows(x.rows() - 1));
  CHECK(box.sizes().x() < 0.99);
  CHECK(box.sizes().y() < 0.15);
  CHECK(box.min().minCoeff() > -1e-12);
}

TEST_CASE("Smoothing shares a long edge's length with its neighbours and keeps the mean place") {
  const TriangleMesh sheet = grid({1, 1}, 11, 11, Diagonals::one_way);
  Positions x = sheet.vertices;
  for (int v = 0; v < x.rows(); ++v)
    if (x(v, 0) > 0.55) x(v, 0) += 3;
  const auto longest = [&](const Positions& at) {
    double most = 0;
    for (const auto& t : sheet.triangles.rowwise())
      for (int k = 0; k < 3; ++k) most = std::max(most, (at.row(t[k]) - at.row(t[(k + 1) % 3])).norm());
    return most;
  };
  const Positions smooth = smoothed(sheet.triangles, x, 4);
  CHECK(longest(smooth) < 0.4 * longest(x));
  CHECK((smooth.colwise().mean() - x.colwise().mean()).norm() < 1e-12);
  CHECK((smoothed(sheet.triangles, x, 0) - x).norm() < 1e-12);
}

TEST_CASE("A sheet whose corner pokes through another one is untangled there, and stays elsewhere") {
  const TriangleMesh flat = grid({1, 1}, 11, 11, Diagonals::criss_cross);
  const int n = static_cast<int>(flat.vertices.rows());
  const Eigen::Vector3d corner = flat.vertices.colwise().maxCoeff();
  TriangleMesh both = flat;  // and an upright copy across that corner
  both.vertices.conservativeResize(2 * n, 3);
  both.triangles.conservativeResize(2 * flat.triangles.rows(), 3);
  both.triangles.bottomRows(flat.triangles.rows()) = flat.triangles.array() + n;
  for (int v = 0; v < n; ++v) {
    const double along = flat.vertices(v, 0) - flat.vertices.col(0).mean() + 0.013;
    both.vertices.row(n + v) << corner.x() - 0.08 + along, corner.y() - 0.07 - along,
        flat.vertices(v, 1) - flat.vertices.col(1).mean() + 0.02;
  }
  REQUIRE(self_intersections(both).size() > 5);
  const TriangleMesh apart = untangled(both, {});
  CHECK(self_intersections(apart).empty());
  const Eigen::VectorXd moves = (apart.vertices - both.vertices).rowwise().norm();
  CHECK(moves.maxCoeff() < 0.15);  // the corner is .11 beyond the other sheet
  CHECK(moves.minCoeff() < 1e-3);
  CHECK(untangled(flat, {}).vertices == flat.vertices);
}

TEST_CASE("A sheet whose corner pokes into an obstacle leaves it, which stays") {
  TriangleMesh ball = unit_sphere(3);
  ball.vertices = 0.3 * ball.vertices;
  TriangleMesh sheet = grid({1, 1}, 13, 13, Diagonals::criss_cross);
  sheet.vertices.rowwise() += Eigen::RowVector3d(-sheet.vertices.col(0).minCoeff() + 0.13,
                                                 -sheet.vertices.col(1).minCoeff() + 0.11, 0);
  REQUIRE(!intersections(sheet, ball).empty());
  const TriangleMesh apart = untangled(sheet, {ball});
  CHECK(intersections(apart, ball).empty());
  CHECK(self_intersections(apart).empty());
  CHECK(!is_inside(apart.vertices, ball));
}

TEST_CASE("Inflation moves a surface along its normals, and leaves two layers' common edge") {
  const TriangleMesh sphere = unit_sphere(3);
  const Eigen::VectorXd radii = inflated(sphere, 0.1).rowwise().norm();
  CHECK(radii.minCoeff() == Approx(1.1).epsilon(1e-4));
  CHECK(radii.maxCoeff() == Approx(1.1).epsilon(1e-4));
  TriangleMesh folded = grid({1, 1}, 5, 3, Diagonals::criss_cross);  // at half of its length onto itself
  for (int v = 0; v < folded.vertices.rows(); ++v)
    if (folded.vertices(v, 0) > 0.5) folded.vertices(v, 0) = 1 - folded.vertices(v, 0);
  const Positions x = inflated(folded, 0.1);
  for (int v = 0; v < x.rows(); ++v) {
    CHECK(std::abs(x(v, 2)) == Approx(folded.vertices(v, 0) == 0.5 ? 0 : 0.1));
    CHECK((x.row(v) - folded.vertices.row(v)).head(2).norm() == 0);
  }
}

TEST_CASE("Rest shapes between two have the mean of their metrics, and turn over nowhere") {
  const Level flat = Level::of(0, as_piece(grid({1, 1}, 5, 5, Diagonals::criss_cross)));
  Positions placed = flat.rest.vertices;
  for (int v = 0; v < placed.rows(); ++v)  // stretched by 80, sheared, and turned out of the plane
    placed.row(v) << 3 * flat.rest.vertices(v, 1) + flat.rest.vertices(v, 0), 0.2,
        -80 * flat.rest.vertices(v, 0);
  for (const double weight : {1.0, 0.1, 1e-4, 0.0}) {
    const Level between = with_intermediate_rest(flat, placed, weight);
    CHECK(between.vertex_area == flat.vertex_area);
    double difference = 0;
    for (int t = 0; t < flat.triangle_count(); ++t) {
      const Eigen::Matrix3d c = rest_corners(between.rest, t), c0 = rest_corners(flat.rest, t);
      const auto v = flat.rest.triangles.row(t);
      for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        const double wanted = weight * (placed.row(v[next]) - placed.row(v[k])).squaredNorm() +
                              (1 - weight) * (c0.col(next) - c0.col(k)).squaredNorm();
        difference = std::max(difference, std::abs((c.col(next) - c.col(k)).squaredNorm() / wanted - 1));
      }
      CHECK((c.col(1) - c.col(0)).cross(c.col(2) - c.col(0)).z() > 0);
    }
    CHECK(difference < 1e-12);
  }
}

TEST_CASE(
    "The tightest piece is that of which a tenth is stretched most, and not one with a corner that is") {
  TriangleMesh two = grid({2, 1}, 21, 11, Diagonals::criss_cross);
  two = as_piece(two);
  two.piece_names = {"left", "right"};
  two.piece.resize(two.triangles.rows());
  for (Eigen::Index t = 0; t < two.triangles.rows(); ++t)
    two.piece[t] = two.vertices(two.triangles(t, 0), 0) + two.vertices(two.triangles(t, 2), 0) > 2 ? 1 : 0;
  const Level level = Level::of(0, two);
  Positions x = two.vertices;
  x(0, 0) -= 5;                       // a corner of the left piece
  for (int v = 0; v < x.rows(); ++v)  // a fifth of the right piece, by half
    if (two.vertices(v, 0) > 1.8) x(v, 0) += 0.5 * (two.vertices(v, 0) - 1.8);
  const Tightness tightest = tightest_piece(level, x);
  CHECK(tightest.piece == 1);
  CHECK(tightest.stretch == Approx(0.5).epsilon(1e-9));
  CHECK(two.piece[tightest.triangle] == 1);
}
