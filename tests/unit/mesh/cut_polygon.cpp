#include "core/numerics/mesh/cut_polygon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>
#include <set>

#include "core/numerics/mesh/area_vectors.h"
#include "tests/unit/mesh/mesh_files.h"

using namespace drape;
using CornerPoint = Eigen::Vector3d;
using CornerList = std::vector<CornerPoint>;
using Catch::Contains;

namespace {

/// Checks that n - 2 triangles, so many of them without an area, face up, fill the outline's area and use
/// each of its sides once.
void check_cut(const CornerList& outline, int without_area = 0) {
  const CutPolygon cut = cut_polygon(outline);
  REQUIRE(cut.fault == "");
  REQUIRE(cut.triangles.size() == outline.size() - 2);
  CornerPoint total = CornerPoint::Zero();
  double area = 0;
  int empty = 0;
  std::set<std::pair<int, int>> sides;
  for (std::size_t k = 0; k < outline.size(); ++k)
    total += outline[k].cross(outline[(k + 1) % outline.size()]) / 2;
  for (const auto& t : cut.triangles) {
    const CornerPoint normal = (outline[t[1]] - outline[t[0]]).cross(outline[t[2]] - outline[t[0]]) / 2;
    const bool is_empty = without_area > 0 && normal.norm() < 1e-12;
    empty += is_empty;
    CHECK(normal.dot(total) > (is_empty ? -1e-15 * total.norm() : 0));
    area += normal.norm();
    for (int k = 0; k < 3; ++k) CHECK(sides.insert({t[k], t[(k + 1) % 3]}).second);
  }
  CHECK(empty == without_area);
  CHECK(area == Approx(total.norm()).epsilon(1e-9));
  const int n = static_cast<int>(outline.size());
  for (int k = 0; k < n; ++k) CHECK(sides.count({k, (k + 1) % n}) == 1);
}

/// Calls `visit` for the outline from each of its corners, in a tilted plane far from the origin.
void from_every_corner(
    CornerList outline,
    const std::function<void(const CornerList&)>& visit = [](const CornerList& o) { check_cut(o); }) {
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd(0.7, CornerPoint(1, 2, 3).normalized()).toRotationMatrix();
  for (CornerPoint& p : outline) p = tilt * p + CornerPoint(30, -20, 10);
  for (std::size_t k = 0; k < outline.size(); ++k) {
    std::rotate(outline.begin(), outline.begin() + 1, outline.end());
    visit(outline);
  }
}

}  // namespace

TEST_CASE("a convex polygon is cut as a fan around its first corner") {
  CornerList outline;
  std::vector<std::array<int, 3>> fan;
  for (int n = 3; n < 12; ++n) {
    outline.clear();
    for (int k = 0; k < n; ++k)
      outline.emplace_back(std::cos(2 * M_PI * k / n), std::sin(2 * M_PI * k / n), 0.02 * (k % 2));
    fan.push_back({0, n - 2, n - 1});
    CHECK(cut_polygon(outline).fault == "");
    CHECK(cut_polygon(outline).triangles == fan);
  }
}

TEST_CASE("concave polygons are cut into what they cover") {
  from_every_corner({{0, 0, 0}, {1, 0.8, 0}, {2, 0, 0}, {1, 2, 0}});  // an arrow head
  from_every_corner({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}});
  CornerList comb{{0, -1, 0}, {20, -1, 0}}, spiral;  // a comb with corners on one line
  for (int k = 20; k >= 0; --k) comb.emplace_back(k, k % 2, 0);
  from_every_corner(comb);
  for (int k = 0; k <= 40; ++k) {
    const CornerPoint ray(std::cos(0.3 * k), std::sin(0.3 * k), 0);
    spiral.insert(spiral.begin(), (1 + 0.1 * k) * ray);
    spiral.push_back((1.8 + 0.1 * k) * ray);
  }
  check_cut(spiral);
}

TEST_CASE("random stars are cut, at any scale") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> radius(0.1, 1);
  for (int round = 0; round < 60; ++round) {
    const int n = 4 + round % 13;
    CornerList outline;
    for (int k = 0; k < n; ++k) {
      const double r = std::pow(10, round % 7 - 3) * radius(random);
      outline.emplace_back(r * std::cos(2 * M_PI * k / n), r * std::sin(2 * M_PI * k / n), 0);
    }
    from_every_corner(outline, [&](const CornerList& turned) {
      if (round % 7 >= 2) check_cut(turned);  // smaller ones are lost to round-off so far from the origin
    });
    check_cut(outline);
  }
}

TEST_CASE("polygons that cross or touch themselves, or are not planar, are refused with the reason") {
  const auto check_fault = [](const CornerList& outline, const std::string& reason) {
    CHECK_THAT(cut_polygon(outline).fault, Contains(reason));
  };
  check_fault({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1.1, 0}}, "crosses or touches itself: its sides 0 and 2");
  CornerList star;  // five corners, two turns
  for (int k = 0; k < 5; ++k) star.emplace_back(std::cos(4 * M_PI * k / 5), std::sin(4 * M_PI * k / 5), 0);
  check_fault(star, "crosses or touches itself");
  // A corner on another side, and a side that runs back.
  check_fault({{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {2, 0, 0}, {0, 2, 0}}, "touches itself");
  check_fault({{0, 0, 0}, {4, 0, 0}, {2, 0, 0}, {0, 2, 0}, {-1, 1, 0}}, "touches itself");
  check_fault({{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}}, "is not planar");
  // Bent as the quads of a curved surface are, and without an area, which check_mesh says.
  CHECK(cut_polygon({{0, 0, 0}, {1, 0, 0.1}, {1, 1, 0}, {0, 1, 0.1}}).fault == "");
  CHECK(cut_polygon({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).fault == "");
}

TEST_CASE("a face with a hole that two of its sides lead to, as CAD programs write it, is cut") {
  for (const int turns : {0, 3, 7}) {
    CornerList keyhole = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {0, 0, 0},
                          {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}};
    std::rotate(keyhole.begin(), keyhole.begin() + turns, keyhole.end());
    const CutPolygon cut = cut_polygon(keyhole);
    CHECK(cut.fault == "");
    double area = 0;
    int empty = 0;
    for (const auto& t : cut.triangles) {
      const CornerPoint normal = (keyhole[t[1]] - keyhole[t[0]]).cross(keyhole[t[2]] - keyhole[t[0]]) / 2;
      CHECK(normal.z() > -1e-12);
      empty += normal.z() < 1e-12;
      area += normal.z();
    }
    CHECK(area == Approx(8));
    CHECK(cut.triangles.size() - empty == 8);
  }
}

TEST_CASE("a face of very many corners is cut without a vertex of very many triangles") {
  for (const bool concave : {false, true}) {
    const int n = concave ? 2000 : 20000;
    CornerList outline;
    for (int k = 0; k < n; ++k) {
      const double angle = 2 * M_PI * k / n, radius = concave && k % 2 ? 0.99 : 1;
      outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    check_cut(outline);
    std::vector<int> triangles_at(n);
    for (const auto& t : cut_polygon(outline).triangles)
      for (const int k : t) ++triangles_at[k];
    CHECK(*std::ranges::max_element(triangles_at) < 2000);
  }
}

TEST_CASE("a bow tie of two equal sides is said to cross itself") {
  for (const CornerList& tie : {CornerList{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},
                                CornerList{{0, 0, 5}, {2, 2, 5}, {2, 0, 5}, {1, 0, 5}, {0, 2, 5}, {0, 1, 5}}})
    CHECK_THAT(cut_polygon(tie).fault, Contains("crosses "));
}

TEST_CASE("corners at one place, as at the poles of a sphere of quads, get triangles without area") {
  CornerList outline = {{0, 0, 0},     {1, 0, 0}, {1, 1, 0},     {1, 1, 0},
                        {0.2, 0.2, 0}, {0, 1, 0}, {0, 1, 1e-15}, {0, 0, 0}};
  for (std::size_t turn = 0; turn < outline.size(); ++turn) {
    std::rotate(outline.begin(), outline.begin() + 1, outline.end());
    check_cut(outline, 3);
  }
  for (const CornerList& pole : {CornerList{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                 CornerList{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}}})
    CHECK(cut_polygon(pole).triangles.size() == 2);
  // All corners but one coincide to round-off.
  const CutPolygon cut =
      cut_polygon({{0, 0, 0}, {1, 0, 0}, {1, 2.4, 777777777777}, {0.4, 0.4, 0}, {0.4, 0.4, 0}, {0, 1, 0}});
  CHECK(cut.fault == "");
  CHECK(cut.triangles.size() == 4);
}

TEST_CASE("a concave face is cut in every format, and one that crosses itself is refused") {
  const std::string name = GENERATE("m.obj", "m.off", "m.ply");
  const auto mesh_of_face = [&](const std::vector<std::string>& points) {
    const bool obj = name == "m.obj";
    const std::string n = std::to_string(points.size());
    std::string vertices, face = obj ? "f" : n;
    for (std::size_t k = 0; k < points.size(); ++k) {
      vertices += (obj ? "v " : "") + points[k] + "\n";
      face += " " + std::to_string(obj ? k + 1 : k);
    }
    if (obj) return mesh_in(name, vertices + face + "\n");
    if (name == "m.off") return mesh_in(name, "OFF\n" + n + " 1 0\n" + vertices + face + "\n");
    return mesh_in(name, "ply\nformat ascii 1.0\n" + faces_head(1) + "element vertex " + n +
                             "\nproperty float x\nproperty float y\nproperty float z\nend_header\n" + face +
                             "\n" + vertices);  // the face before its vertices
  };
  const TriangleMesh mesh = mesh_of_face({"0 1 0", "0 1 0.4", "0 0.4 0.4", "0 0.4 1", "0 0 1", "0 0 0"});
  REQUIRE(mesh.triangles.rows() == 4);
  const Positions areas = area_vectors(mesh);
  CHECK(areas.col(0).minCoeff() > 1e-3);
  CHECK(areas.rowwise().norm().sum() / 2 == Approx(0.64));
  CHECK_THROWS_WITH(mesh_of_face({"0 0 0", "1 1 0", "1 0 0", "0 1.1 0"}),
                    Contains("face 0 (counted from 0) crosses or touches itself: its sides 0 and 2"));
}
