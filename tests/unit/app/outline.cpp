#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "core/app/picture/render.h"
#include "core/numerics/patterns/generate.h"

using namespace drape;

namespace {

constexpr int size = 200;  // of the pictures [pixels]
const Eigen::Vector3f red(1, 0, 0);

TriangleMesh unit_square() { return grid({1, 1}, 2, 2, Diagonals::one_way); }

Image grey() { return {size, size, std::vector<unsigned char>(3 * size * size, 128)}; }

/// Half the side of the square as from_above shows it, whose margin is 1.06 [pixels].
constexpr double half = size / 2 / 1.06;

/// The distance of a pixel's centre from the sides of the square [pixels].
double distance_from_sides(int column, int row) {
  const double u = std::abs(column + 0.5 - size / 2), v = std::abs(row + 0.5 - size / 2);
  if (u < half && v < half) return half - std::max(u, v);
  return std::hypot(std::max(u - half, 0.0), std::max(v - half, 0.0));
}

/// The camera that sees a mesh in the plane z = 0 from above, y upwards.
Camera from_above(const TriangleMesh& flat) { return Camera::around({&flat.vertices}, {0, 0, 1}, 1); }

}  // namespace

TEST_CASE("the outline of a square that faces the camera lies on its four sides") {
  const TriangleMesh square = unit_square();
  Image image = grey();
  draw_outline(image, square, from_above(square), red);
  int on = 0, off = 0;
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const unsigned char* pixel = &image.pixels[3 * (row * size + column)];
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
  Image image = grey();
  draw_outline(image, frame, from_above(frame), red);
  const auto is_drawn = [&](int column, int row) { return image.pixels[3 * (row * size + column)] > 170; };
  const int hole = static_cast<int>(size / 2 + half / 2);  // the pixel of its right side
  CHECK((is_drawn(hole, size / 2) || is_drawn(hole - 1, size / 2) || is_drawn(hole + 1, size / 2)));
  CHECK_FALSE(is_drawn(size / 2, size / 2));
  int drawn = 0;  // between the hole and the square's right side, where a triangle's edge runs
  for (int column = hole + 5; column < size / 2 + half - 5; ++column) drawn += is_drawn(column, size / 2);
  CHECK(drawn == 0);
}

TEST_CASE("a mesh that the camera does not see changes no pixel") {
  const TriangleMesh square = unit_square();
  const Camera camera = from_above(square);
  for (const Eigen::RowVector3d& away : {Eigen::RowVector3d(10, 0, 0), Eigen::RowVector3d(0, 0, 10)}) {
    CAPTURE(away[0], away[2]);
    TriangleMesh other = square;
    other.vertices.rowwise() += away;
    Image image = grey();
    draw_outline(image, other, camera, red);
    CHECK(image.pixels == grey().pixels);
  }
}
