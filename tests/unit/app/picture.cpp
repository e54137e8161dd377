#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "core/app/picture/ray_scene.h"
#include "core/app/picture/render.h"
#include "core/app/picture/surface.h"
#include "core/kernel/threads/parallel.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/any_threads.h"

using namespace drape;

namespace {

/// A dome over the unit square, 0.3 high.
TriangleMesh dome(int n) {
  TriangleMesh mesh = grid({1, 1}, n, n, Diagonals::one_way);
  for (int i = 0; i < n * n; ++i)
    mesh.vertices(i, 2) = 4.8 * mesh.vertices(i, 0) * (1 - mesh.vertices(i, 0)) * mesh.vertices(i, 1) *
                          (1 - mesh.vertices(i, 1));
  return mesh;
}

TriangleMesh cube(double edge) {
  TriangleMesh mesh = unit_box();
  mesh.vertices *= edge;
  return mesh;
}

int brightness(const Image& image, int column, int row) {
  const unsigned char* p = &image.pixels[3 * (static_cast<std::size_t>(row) * image.width + column)];
  return p[0] + p[1] + p[2];
}

/// Where a point is seen: right and up, −1 … 1 within the picture, and how far ahead [m].
Eigen::Vector3d seen(const Camera& camera, const Eigen::Vector3d& point) {
  const Eigen::Vector3d p = camera.frame * point - camera.eye;
  return {p[0] / (-p[2] * camera.tangent[0]), p[1] / (-p[2] * camera.tangent[1]), -p[2]};
}

/// Where a point is seen [pixels].
Eigen::Vector2i pixel_of(const Eigen::Vector3d& point, const Camera& camera, const Image& image) {
  const Eigen::Vector3d p = seen(camera, point);
  return {static_cast<int>((p[0] + 1) / 2 * image.width), static_cast<int>((1 - p[1]) / 2 * image.height)};
}

}  // namespace

TEST_CASE("the camera sees all of every state and wastes no picture") {
  const TriangleMesh sheet = grid({1, 1}, 9, 9, Diagonals::one_way);
  Positions other = sheet.vertices.array() * 1.7 + 0.4;
  other(3, 0) = std::numeric_limits<double>::infinity();
  const Camera camera = Camera::around({&sheet.vertices, &other}, {0.55, -1, 0.68}, 9.0 / 7);
  double reach = 0;
  for (const Positions* x : {&sheet.vertices, static_cast<const Positions*>(&other)}) {
    for (int i = 0; i < x->rows(); ++i) {
      if (!x->row(i).allFinite()) continue;
      const Eigen::Vector3d p = seen(camera, x->row(i));
      CHECK(p[2] > 0);
      CHECK(p.head<2>().cwiseAbs().maxCoeff() < 1);
      reach = std::max(reach, p.head<2>().cwiseAbs().maxCoeff());
    }
  }
  CHECK(reach > 0.9);
  const Camera above = Camera::around({&sheet.vertices}, {0, 0, 2}, 1);
  const Eigen::Vector3d far_side = seen(above, {0.5, 1, 0});
  CHECK(far_side[0] == Approx(0).margin(1e-12));  // y is up
  CHECK(far_side[1] == Approx(1 / 1.06));
}

TEST_CASE("a drawing shows both sides of the cloth") {
  TriangleMesh sheet = grid({1, 1}, 5, 5, Diagonals::one_way);
  const auto middle = [&](const Drawing& drawing, const Camera& camera) {
    const Image image = render(drawing, camera, 60, 60);
    const unsigned char* p = &image.pixels[3 * (30 * 60 + 30)];
    return Eigen::Vector3i(p[0], p[1], p[2]);
  };
  const Camera above = Camera::around({&sheet.vertices}, {0.2, -0.3, 1}, 1);
  const Eigen::Vector3i front = middle({sheet}, above);
  CHECK(front[0] > front[2] + 10);  // warm
  sheet.triangles.col(1).swap(sheet.triangles.col(2));
  const Eigen::Vector3i back = middle({sheet}, above);
  CHECK(back[2] > back[0] + 5);  // cool
  CHECK(std::min(front.minCoeff(), back.minCoeff()) > 90);
  CHECK(middle({sheet, true}, above).sum() <= back.sum());
}

TEST_CASE("a picture has the same bits on any number of threads, and from one drawing to the next") {
  const TriangleMesh cloth = dome(12), block = cube(0.4);
  Drawing drawing{cloth};
  drawing.obstacles = {&block};
  drawing.floor = -0.2;
  const Camera camera = Camera::around({&cloth.vertices, &block.vertices}, {0.55, -1, 0.68}, 1.25);
  same_with_any_threads([&] { return render(drawing, camera, 125, 100).pixels; });
}

TEST_CASE("a floor shows shadows and nothing else") {
  const TriangleMesh cloth = dome(12);
  const Camera camera = Camera::around({&cloth.vertices}, {0.55, -1, 0.68}, 1);
  Drawing drawing{cloth};
  const Image without = render(drawing, camera, 80, 80);
  drawing.floor = -0.1;
  const Image with = render(drawing, camera, 80, 80);
  int darker = 0, brighter = 0;
  for (int row = 0; row < 80; ++row)
    for (int column = 0; column < 80; ++column) {
      const int change = brightness(with, column, row) - brightness(without, column, row);
      darker += change < -60;
      brighter += change > 0;
    }
  CHECK(darker > 300);
  CHECK(brighter == 0);

  const TriangleMesh flat = grid({1, 1}, 5, 5, Diagonals::one_way);
  Drawing lying{flat};
  const Image hanging = render(lying, camera, 80, 80);
  lying.floor = 0;
  const Image on_floor = render(lying, camera, 80, 80);
  const Eigen::Vector2i middle = pixel_of({0.5, 0.5, 0}, camera, hanging);
  for (int column = middle[0] - 15; column < middle[0] + 15; ++column)
    CHECK(brightness(on_floor, column, middle[1]) == brightness(hanging, column, middle[1]));
}

TEST_CASE("a coarse ball's flat triangles do not shadow the light that reaches its smooth normals") {
  const TriangleMesh mesh = unit_sphere(2);
  const RayScene scene(Drawing{mesh});
  const Eigen::Vector3f light = Eigen::Vector3f(-0.6f, 0.1f, 0.5f).normalized();
  int lit = 0, blocked = 0, dark = 0;
  for (int row = -40; row <= 40; ++row)
    for (int column = -40; column <= 40; ++column) {
      const auto point = scene.nearest({{column / 45.0f, -3, row / 45.0f}, {0, 1, 0}});
      if (!point) continue;
      const bool arrives = !scene.blocked({point->light_origin, light});
      const float cosine = point->normal.dot(light);
      lit += cosine > 0.02f;
      blocked += cosine > 0.02f && !arrives;
      dark += cosine < -0.2f && !arrives;
    }
  CHECK(lit > 1500);
  CHECK(blocked == 0);
  CHECK(dark > 1000);
}

TEST_CASE("an obstacle shows through cloth under X-rays alone") {
  const TriangleMesh cloth = dome(12);
  TriangleMesh block = cube(0.2);
  block.vertices.rowwise() += Eigen::RowVector3d(0.5, 0.5, 0.1);
  const Camera camera = Camera::around({&cloth.vertices}, {0.2, -0.3, 1}, 1);
  const auto taken = [&](bool xray, const Eigen::Vector3d& point) {
    Drawing drawing{.mesh = cloth, .xray = xray};
    const Image alone = render(drawing, camera, 80, 80);
    drawing.obstacles = {&block};
    const Image both = render(drawing, camera, 80, 80);
    const Eigen::Vector2i p = pixel_of(point, camera, alone);
    return brightness(alone, p[0], p[1]) - brightness(both, p[0], p[1]);
  };
  CHECK(taken(true, {0.5, 0.5, 0.3}) > 8);
  CHECK(std::abs(taken(true, {0.2, 0.2, 0.123})) <= 2);
  CHECK(std::abs(taken(false, {0.5, 0.5, 0.3})) <= 2);
}

TEST_CASE("edges are drawn where asked for") {
  const TriangleMesh sheet = grid({1, 1}, 5, 5, Diagonals::one_way);
  const Camera camera = Camera::around({&sheet.vertices}, {0.2, -0.3, 1}, 1);
  Drawing drawing{sheet};
  const Image plain = render(drawing, camera, 200, 200);
  drawing.edges = true;
  const Image lines = render(drawing, camera, 200, 200);
  const Eigen::Vector2i on = pixel_of({0.5, 0.375, 0}, camera, plain);
  const Eigen::Vector2i off = pixel_of({0.42, 0.33, 0}, camera, plain);
  CHECK(brightness(lines, on[0], on[1]) < brightness(plain, on[0], on[1]) - 20);
  CHECK(brightness(lines, off[0], off[1]) == brightness(plain, off[0], off[1]));
}

TEST_CASE("a picture is left when asked, and triangles that are not finite are left out") {
  TriangleMesh sheet = grid({1, 1}, 5, 5, Diagonals::one_way);
  const Camera camera = Camera::around({&sheet.vertices}, {0, 0, 1}, 1);
  int polls = 0;
  set_thread_count(1);  // the thread that draws polls; with helpers it may get few rows
  CHECK_THROWS_AS(render({sheet}, camera, 100, 100, [&] { return ++polls == 3; }), RenderingCancelled);
  set_thread_count(0);
  CHECK(polls == 3);
  const Image whole = render({sheet}, camera, 50, 50);
  sheet.vertices(12, 0) = std::nan("");
  const Image hole = render({sheet}, camera, 50, 50);
  CHECK(brightness(hole, 25, 25) == brightness(hole, 0, 0));  // the backdrop
  CHECK(brightness(whole, 25, 25) != brightness(whole, 0, 0));
  CHECK(brightness(hole, 5, 40) == brightness(whole, 5, 40));
}

TEST_CASE("normals are smooth over a dome and stop at a cube's edges") {
  Positions normals;
  const TriangleMesh split = split_at_creases(unit_box(), normals);
  REQUIRE(split.vertices.rows() == 36);
  for (int i = 0; i < 36; ++i) CHECK(normals.row(i).cwiseAbs().maxCoeff() == Approx(1));
  const TriangleMesh round = dome(12);
  const TriangleMesh parts = split_at_creases(round, normals);
  const Positions smooth = smooth_normals(round);
  for (int t = 0; t < round.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      CHECK(parts.vertices.row(parts.triangles(t, k)) == round.vertices.row(round.triangles(t, k)));
      CHECK((normals.row(parts.triangles(t, k)) - smooth.row(round.triangles(t, k))).norm() < 1e-12);
    }
}
