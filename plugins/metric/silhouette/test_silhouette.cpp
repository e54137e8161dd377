
#include "core/numerics/hierarchy/midpoint.h"
#include "tests/support/meshes.h"
#include "tests/support/metric_check.h"
#include "tests/support/unregistered.h"
// After it:
#include "plugins/metric/silhouette/silhouette.cpp"

using namespace drape;

namespace {

MetricResult evaluate(const Level& level, const Positions& x, const Positions& other, int resolution = 256) {
  Silhouette silhouette;
  silhouette.resolution = resolution;
  return silhouette.evaluate({level, empty_model(), x, &other});
}

double overlap(const Level& level, const Positions& x, const Positions& other) {
  return value(evaluate(level, x, other), "silhouette_overlap");
}

Positions wavy(const Level& level, double phase) {
  Positions x = level.rest.vertices;
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    x(i, 2) = 0.2 * std::sin(5 * x(i, 0) + phase) * std::cos(3 * x(i, 1) - phase);
  return x;
}

Positions shifted(const Positions& x, double dx, double dy, double dz) {
  return x.rowwise() + Eigen::RowVector3d(dx, dy, dz);
}

}  // namespace

TEST_CASE("Twelve directions of view lie evenly") {
  const auto views = Silhouette::directions();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < views.size(); ++i) {
    CHECK(views[i].norm() == Approx(1).epsilon(1e-14));
    second += views[i] * views[i].transpose() / views.size();
    for (std::size_t j = 0; j < i; ++j)  // 41.9° apart, whichever way a view looks
      CHECK(std::abs(views[i].dot(views[j])) < std::cos(41.8 * M_PI / 180));
  }
  CHECK((second - Eigen::Matrix3d::Identity() / 3).norm() < 1e-14);
}

TEST_CASE("A shifted square covers a third of both, a smaller one a quarter, one beside it nothing") {
  const Level level = square(7);
  const Positions& x = level.rest.vertices;
  // Every view sees a parallelogram.
  CHECK(overlap(level, x, shifted(x, 0.5, 0, 0)) == Approx(1.0 / 3).margin(0.01));
  const MetricResult fine = evaluate(level, x, shifted(x, 0.5, 0, 0), 2048);
  CHECK(value(fine, "silhouette_overlap") == Approx(1.0 / 3).margin(1e-3));
  CHECK(value(fine, "silhouette_lowest") == Approx(1.0 / 3).margin(2e-3));
  CHECK(overlap(level, x, 0.5 * x) == Approx(0.25).margin(0.01));
  // In a direction that no view looks along.
  for (const MetricValue& v : evaluate(level, x, shifted(x, 20, 30, 0)).values) CHECK(v.value == 0);
}

TEST_CASE("A hole stays open") {
  // A square without its middle quarter, within the hole of one that is twice as large.
  const Level whole = square(4);
  const Positions centred = shifted(whole.rest.vertices, -0.5, -0.5, 0);
  TriangleMesh ring{centred, Triangles(0, 3)};
  for (const auto& t : whole.rest.triangles.rowwise()) {
    const Eigen::RowVector3d centre = (centred.row(t[0]) + centred.row(t[1]) + centred.row(t[2])) / 3;
    if (centre.cwiseAbs().maxCoeff() > 0.25) append(ring, {}, {Eigen::Vector3i(t)});
  }
  REQUIRE(ring.triangles.rows() == 24);
  // The vertex in the middle belongs to no triangle: the level is made without a check of the mesh.
  CHECK(overlap(Level::of(0, ring), centred, 2 * centred) == Approx(0).margin(0.02));
}

TEST_CASE("Neither the order of vertices, corners and triangles matters, nor a split at edges' midpoints") {
  const Level level = square(9);
  const Positions x = wavy(level, 0.3), other = wavy(level, 1.1);
  const double expected = overlap(level, x, other);
  REQUIRE(expected < 0.99);
  REQUIRE(expected > 0.3);
  const int n = level.vertex_count(), m = level.triangle_count();
  Eigen::PermutationMatrix<Eigen::Dynamic> mix(n);
  for (int i = 0; i < n; ++i) mix.indices()[i] = (7 * i + 3) % n;  // n = 100
  Triangles triangles(m, 3);
  for (int t = 0; t < m; ++t)
    for (int k = 0; k < 3; ++k) triangles(m - 1 - t, (k + t) % 3) = mix.indices()[level.rest.triangles(t, k)];
  const Level mixed = Level::of(0, {mix * level.rest.vertices, triangles});
  CHECK(overlap(mixed, mix * x, mix * other) == expected);
  CHECK(overlap(mixed, mix * other, mix * x) == expected);
  const ProlongationMatrix midpoints = midpoint_weights(level);
  const Level fine = Level::of(1, refined_rest(level, midpoints));
  CHECK(overlap(fine, midpoints * x, midpoints * other) == Approx(expected).epsilon(1e-4));
}

TEST_CASE("Triangles that have collapsed cover nothing, and a state that has flown apart fits the pixels") {
  const Level level = square(4);
  const Positions& x = level.rest.vertices;
  Positions line = x, collapsed = x;
  line.col(1).setZero();
  CHECK(overlap(level, x, line) == 0);
  CHECK(overlap(level, line, line) == 1);  // nothing differs
  const Positions point = Positions::Constant(x.rows(), 3, 0.25);
  CHECK(overlap(level, point, point) == 1);
  // One row of vertices on the next: a row of triangles without area, the others cover the square.
  for (auto p : collapsed.rowwise())
    if (p[1] == 0.25) p[1] = 0;
  CHECK(overlap(level, x, collapsed) == 1);
  CHECK(overlap(level, x, 1e9 * x) == Approx(0).margin(1e-6));
  CHECK(overlap(level, 1e9 * x, 1e9 * x) == 1);
}
