// Pictures of a cloth: what a camera sees, light and shadow, and outlines over them.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "core/app/picture/ray_scene.h"
#include "core/app/picture/render.h"
#include "core/numerics/mesh/area_vectors.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/any_threads.h"

using namespace drape;

namespace {

/// A dome over the unit square, 0.3 high.
TriangleMesh dome(int n) {
  TriangleMesh mesh = grid({1, 1}, n, n, Diagonals::one_way);
  for (auto v : mesh.vertices.rowwise()) v[2] = 4.8 * v[0] * (1 - v[0]) * v[1] * (1 - v[1]);
  return mesh;
}

TriangleMesh cube(double edge) {
  TriangleMesh mesh = unit_box();
  mesh.vertices *= edge;
  return mesh;
}

TriangleMesh unit_sheet(int n = 5) { return grid({1, 1}, n, n, Diagonals::one_way); }

/// The camera that sees all of a mesh, nearly from above.
Camera above(const TriangleMesh& mesh) { return Camera::around({&mesh.vertices}, {0.2, -0.3, 1}, 1); }

/// Red, green and blue at a column and a row.
Eigen::Vector3i colour_at(const Image& image, const Eigen::Vector2i& pixel) {
  const unsigned char* p = &image.pixels[3 * (static_cast<std::size_t>(pixel[1]) * image.width + pixel[0])];
  return {p[0], p[1], p[2]};
}

int brightness(const Image& image, const Eigen::Vector2i& pixel) { return colour_at(image, pixel).sum(); }

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

constexpr int size = 200;  // of the pictures [pixels]

/// Half the side of the unit square as from_above shows it, whose margin is 1.06 [pixels].
constexpr double half = size / 2 / 1.06;

/// The distance of a pixel's centre from the sides of the square [pixels].
double distance_from_sides(int column, int row) {
  const double u = std::abs(column + 0.5 - size / 2), v = std::abs(row + 0.5 - size / 2);
  if (u < half && v < half) return half - std::max(u, v);
  return std::hypot(std::max(u - half, 0.0), std::max(v - half, 0.0));
}

/// The camera that sees a mesh in the plane z = 0 from above, y upwards.
Camera from_above(const TriangleMesh& flat) { return Camera::around({&flat.vertices}, {0, 0, 1}, 1); }

/// The mesh's outline in red on a grey picture, by its pixels' red, green and blue.
std::vector<unsigned char> outline_of(const TriangleMesh& mesh, const Camera& camera) {
  Image image{size, size, std::vector<unsigned char>(3 * size * size, 128)};
  draw_outline(image, mesh, camera, {1, 0, 0});
  return image.pixels;
}

}  // namespace

TEST_CASE("the camera sees all of every state and wastes no picture") {
  const TriangleMesh sheet = unit_sheet(9);
  Positions other = sheet.vertices.array() * 1.7 + 0.4;
  other(3, 0) = std::numeric_limits<double>::infinity();
  const Camera camera = Camera::around({&sheet.vertices, &other}, {0.55, -1, 0.68}, 9.0 / 7);
  double reach = 0;
  for (const Positions& x : {sheet.vertices, other})
    for (const auto& vertex : x.rowwise()) {
      if (!vertex.allFinite()) continue;
      const Eigen::Vector3d p = seen(camera, vertex);
      CHECK(p[2] > 0);
      CHECK(p.head<2>().cwiseAbs().maxCoeff() < 1);
      reach = std::max(reach, p.head<2>().cwiseAbs().maxCoeff());
    }
  CHECK(reach > 0.9);
  const Eigen::Vector3d far_side = seen(Camera::around({&sheet.vertices}, {0, 0, 2}, 1), {0.5, 1, 0});
  CHECK(far_side[0] == Approx(0).margin(1e-12));  // y is up
  CHECK(far_side[1] == Approx(1 / 1.06));
}

TEST_CASE("a drawing shows both sides of the cloth") {
  TriangleMesh sheet = unit_sheet();
  const auto middle = [&](const Drawing& drawing) {
    return colour_at(render(drawing, above(sheet), 60, 60), {30, 30});
  };
  const Eigen::Vector3i front = middle({sheet});
  CHECK(front[0] > front[2] + 10);  // warm
  sheet.triangles.col(1).swap(sheet.triangles.col(2));
  const Eigen::Vector3i back = middle({sheet});
  CHECK(back[2] > back[0] + 5);  // cool
  CHECK(std::min(front.minCoeff(), back.minCoeff()) > 90);
  CHECK(middle({sheet, true}).sum() <= back.sum());
}

TEST_CASE("a picture has the same bits on any number of threads, and from one drawing to the next") {
  const TriangleMesh cloth = dome(12), block = cube(0.4);
  const Drawing drawing{.mesh = cloth, .obstacles = {&block}, .floor = -0.2};
  const Camera camera = Camera::around({&cloth.vertices, &block.vertices}, {0.55, -1, 0.68}, 1.25);
  same_with_any_threads([&] { return render(drawing, camera, 125, 100).pixels; });
}

TEST_CASE("a floor shows shadows and nothing else") {
  const TriangleMesh cloth = dome(12), flat = unit_sheet();
  const Camera camera = Camera::around({&cloth.vertices}, {0.55, -1, 0.68}, 1);
  const auto picture = [&](const TriangleMesh& mesh, std::optional<double> floor) {
    return render({.mesh = mesh, .floor = floor}, camera, 80, 80);
  };
  const Image without = picture(cloth, {}), with = picture(cloth, -0.1);
  int darker = 0, brighter = 0;
  for (int row = 0; row < 80; ++row)
    for (int column = 0; column < 80; ++column) {
      const int change = brightness(with, {column, row}) - brightness(without, {column, row});
      darker += change < -60;
      brighter += change > 0;
    }
  CHECK(darker > 300);
  CHECK(brighter == 0);

  const Image hanging = picture(flat, {}), lying = picture(flat, 0);
  const Eigen::Vector2i middle = pixel_of({0.5, 0.5, 0}, camera, hanging);
  for (int column = middle[0] - 15; column < middle[0] + 15; ++column)
    CHECK(brightness(lying, {column, middle[1]}) == brightness(hanging, {column, middle[1]}));
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
  const Camera camera = above(cloth);
  const auto taken = [&](bool xray, const Eigen::Vector3d& point) {
    const Image alone = render({.mesh = cloth, .xray = xray}, camera, 80, 80);
    const Image both = render({.mesh = cloth, .xray = xray, .obstacles = {&block}}, camera, 80, 80);
    const Eigen::Vector2i p = pixel_of(point, camera, alone);
    return brightness(alone, p) - brightness(both, p);
  };
  CHECK(taken(true, {0.5, 0.5, 0.3}) > 8);
  CHECK(std::abs(taken(true, {0.2, 0.2, 0.123})) <= 2);
  CHECK(std::abs(taken(false, {0.5, 0.5, 0.3})) <= 2);
}

TEST_CASE("a cloth has its colour before a light or a dark backdrop") {
  const TriangleMesh cloth = dome(12);
  const Camera camera = above(cloth);
  const Image blue =
      render({.mesh = cloth, .colours = {Eigen::Vector3f(0.2f, 0.3f, 0.8f), true}}, camera, 80, 80);
  const Eigen::Vector3i top = colour_at(blue, pixel_of({0.5, 0.5, 0.3}, camera, blue));
  CHECK(top[2] > 1.5 * top[0]);
  CHECK(brightness(blue, {0, 0}) < 150);
  CHECK(brightness(render({.mesh = cloth}, camera, 80, 80), {0, 0}) > 700);
}

TEST_CASE("edges are drawn where asked for") {
  const TriangleMesh sheet = unit_sheet();
  const Camera camera = above(sheet);
  const Image plain = render({sheet}, camera, 200, 200);
  const Image lines = render({.mesh = sheet, .edges = true}, camera, 200, 200);
  const Eigen::Vector2i on = pixel_of({0.5, 0.375, 0}, camera, plain);
  const Eigen::Vector2i off = pixel_of({0.42, 0.33, 0}, camera, plain);
  CHECK(brightness(lines, on) < brightness(plain, on) - 20);
  CHECK(brightness(lines, off) == brightness(plain, off));
}

TEST_CASE("triangles that are not finite are left out of a picture") {
  TriangleMesh sheet = unit_sheet();
  const Camera camera = Camera::around({&sheet.vertices}, {0, 0, 1}, 1);
  const Image whole = render({sheet}, camera, 50, 50);
  sheet.vertices(12, 0) = std::nan("");
  const Image hole = render({sheet}, camera, 50, 50);
  CHECK(brightness(hole, {25, 25}) == brightness(hole, {0, 0}));  // the backdrop
  CHECK(brightness(whole, {25, 25}) != brightness(whole, {0, 0}));
  CHECK(brightness(hole, {5, 40}) == brightness(whole, {5, 40}));
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

TEST_CASE("the outline of a square lies on its four sides where the camera sees them") {
  const TriangleMesh square = grid({1, 1}, 2, 2, Diagonals::one_way);
  const Camera camera = from_above(square);
  const std::vector<unsigned char> pixels = outline_of(square, camera);
  int on = 0, off = 0;
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const unsigned char* pixel = &pixels[3 * (row * size + column)];
      const double distance = distance_from_sides(column, row);
      if (distance < 0.4) {
        ++on;
        if (!(pixel[0] > 170 && pixel[1] < 110 && pixel[2] == pixel[1]))
          FAIL_CHECK("a gap at column " << column << ", row " << row);
      } else if (distance > 2) {
        ++off;
        if (!(pixel[0] == 128 && pixel[1] == 128 && pixel[2] == 128))
          FAIL_CHECK("a stray pixel at column " << column << ", row " << row);
      }
    }
  CHECK(on > 4 * 180);
  CHECK(off > 0.9 * size * size);
  for (const Eigen::RowVector3d& away : {Eigen::RowVector3d(10, 0, 0), Eigen::RowVector3d(0, 0, 10)}) {
    TriangleMesh unseen = square;
    unseen.vertices.rowwise() += away;
    CHECK((outline_of(unseen, camera) == std::vector<unsigned char>(pixels.size(), 128)));
  }
}

TEST_CASE("a hole in a mesh has an outline too, an edge between two triangles none") {
  TriangleMesh frame{Positions(8, 3), Triangles(8, 3)};  // a square of side 1/2 is left out of the middle
  for (int k = 0; k < 4; ++k) {
    const double x = k == 1 || k == 2, y = k >= 2;
    frame.vertices.row(k) << x, y, 0;
    frame.vertices.row(4 + k) << 0.25 + x / 2, 0.25 + y / 2, 0;
    const int next = (k + 1) % 4;
    frame.triangles.row(2 * k) << k, next, 4 + next;
    frame.triangles.row(2 * k + 1) << k, 4 + next, 4 + k;
  }
  const std::vector<unsigned char> pixels = outline_of(frame, from_above(frame));
  const auto is_drawn = [&](int column) { return pixels[3 * (size / 2 * size + column)] > 170; };
  const int hole = static_cast<int>(size / 2 + half / 2);  // the pixel of its right side
  CHECK((is_drawn(hole) || is_drawn(hole - 1) || is_drawn(hole + 1)));
  CHECK_FALSE(is_drawn(size / 2));
  int drawn = 0;  // between the hole and the square's right side, where a triangle's edge runs
  for (int column = hole + 5; column < size / 2 + half - 5; ++column) drawn += is_drawn(column);
  CHECK(drawn == 0);
}
