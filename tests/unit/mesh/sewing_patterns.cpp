// Sewing patterns: curves of edges, meshes of panels, and what their seams join.

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "core/app/experiment/pattern_file.h"
#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/mesh/area_vectors.h"
#include "core/numerics/mesh/check.h"
#include "core/numerics/mesh/seams.h"
#include "core/numerics/patterns/delaunay.h"
#include "core/numerics/sewing/panel_meshes.h"
#include "core/numerics/sewing/sew_pattern.h"
#include "tests/support/command.h"
#include "tests/support/sewn.h"

using namespace drape;
using Catch::Contains;
using Eigen::Vector2d;

namespace {

std::string in_metres(const std::string& text) {
  return text.starts_with("properties") ? text : "properties: {units_in_meter: 1}\n" + text;
}

Pattern pattern_of(const std::string& text) {
  const Scratch folder;
  folder.write("p.yaml", in_metres(text));
  ConfigErrors errors;
  const auto pattern = read_pattern(folder / "p.yaml", errors);
  INFO((errors.empty() ? "" : errors[0].text()));
  REQUIRE(pattern);
  return *pattern;
}

TriangleMesh sewn(const std::string& text, double edge_length) {
  ConfigErrors errors;
  const auto cloth = sew_pattern(pattern_of(text), edge_length, errors);
  INFO((errors.empty() ? "" : errors[0].text()));
  REQUIRE(cloth);
  return *cloth;
}

/// The first error of a pattern that cannot be sewn, without its file.
std::string refused_pattern(const std::string& text, double edge_length = 0.02) {
  const Scratch folder;
  folder.write("p.yaml", in_metres(text));
  ConfigErrors errors;
  if (const auto pattern = read_pattern(folder / "p.yaml", errors))
    sew_pattern(*pattern, edge_length, errors);
  if (errors.empty()) return "";
  const std::string said = errors[0].text();
  return said.substr(said.find("p.yaml:") + 7);
}

double flat_area(const TriangleMesh& cloth) {
  double area = 0;
  for (Eigen::Index t = 0; t < cloth.triangles.rows(); ++t) {
    const Eigen::Matrix3d x = rest_corners(cloth, t);
    area += (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).norm() / 2;
  }
  return area;
}

/// A panel of a square of this side [m], and another on top of it.
std::string squares(const std::string& stitches, double side = 0.2) {
  const std::string s = std::to_string(side);
  const std::string outline = "vertices: [[0, 0], [" + s + ", 0], [" + s + ", " + s + "], [0, " + s + "]]";
  return "pattern:\n  panels:\n    front: {translation: [0, 0, 0.1], " + outline +
         ", edges: {bottom: [0, 1], right: [1, 2], top: [2, 3], left: [3, 0]}}\n    back: {" + outline +
         ", edges: {left: [0, 3], top: [3, 2], right: [2, 1], bottom: [1, 0]}}\n  stitches: " + stitches +
         "\n";
}

/// A panel of this outline as `edge`, closed by a line below it.
PanelEdge edge_with(const std::string& curvature) {
  return pattern_of(
             "pattern: {panels: {p: {vertices: [[1, 1], [3, 1], [2, 0]], edges: [{endpoints: [0, 1], "
             "curvature: " +
             curvature + "}, [1, 2], [2, 0]]}}}")
      .panels[0]
      .edges[0];
}

}  // namespace

TEST_CASE("edges of panels are Bézier curves and arcs, relative to their ends, measured along the curve") {
  const EdgeCurve parabola = EdgeCurve::bezier({Vector2d(0, 0), Vector2d(0.5, 0), Vector2d(1, 1)});  // y = x²
  CHECK((parabola.at(0.5) - Vector2d(0.5, 0.25)).norm() < 1e-15);
  CHECK(parabola.length() == Approx(std::sqrt(5) / 2 + std::asinh(2) / 4).epsilon(1e-10));
  const EdgeCurve part = parabola.between(0.2, 0.9);
  CHECK(part.length() == Approx(0.7).epsilon(1e-5));
  for (const double t : {0.0, 0.3, 1.0}) CHECK(part.at(t).y() == Approx(part.at(t).x() * part.at(t).x()));
  CHECK((part.at(0) - parabola.at_length(0.2)).norm() < 1e-12);

  CHECK((edge_with("{type: quadratic, params: [[0.5, 0.25]]}").curve.at(0.5) - Vector2d(2, 1.25)).norm() <
        1e-15);
  CHECK((edge_with("[0.5, 0.25]").curve.at(0.5) - Vector2d(2, 1.25)).norm() < 1e-15);
  CHECK((edge_with("{type: cubic, params: [[0, 0.5], [1, 0.5]]}").curve.at(0.5) - Vector2d(2, 1.75)).norm() <
        1e-15);
  CHECK((edge_with("{type: circle, params: [1, 0, 0]}").curve.at(0.5) - Vector2d(2, 2)).norm() < 1e-15);
  const EdgeCurve wide = edge_with("{type: circle, params: [1.25, 1, false]}").curve;
  CHECK((wide.at(0.5) - Vector2d(2, 1 + 1.25 + 0.75)).norm() < 1e-14);
  CHECK(wide.length() == Approx(1.25 * (2 * M_PI - 2 * std::asin(0.8))));
  CHECK((wide.at_length(wide.length()) - Vector2d(3, 1)).norm() < 1e-14);
}

TEST_CASE("curves of absolute coordinates, units and named vertices are those of the plain form") {
  const std::string plain =
      "properties: {units_in_meter: 100}\npattern: {panels: {p: {vertices: [[0, 0], [10, 0], [5, 8]], edges: "
      "[{endpoints: [0, 1], curvature: [0.5, -0.2]}, {endpoints: [1, 2]}, {endpoints: [2, 0]}]}}}";
  const std::string other =
      "properties: {units_in_meter: 1000, curvature_coords: absolute}\npattern: {panels: {p: {vertices: {a: "
      "[0, 0], b: "
      "[100, 0], c: [50, 80]}, edges: {hem: {endpoints: [a, b], curvature: [50, -20]}, r: [b, c], l: [c, "
      "a]}}}}";
  const TriangleMesh a = sewn(plain, 0.01), b = sewn(other, 0.01);
  CHECK(a.triangles == b.triangles);
  CHECK((a.vertices - b.vertices).norm() < 1e-14);
}

TEST_CASE(
    "a panel of arcs has the area of its polygon, its holes are empty, and no vertex is added to its "
    "border") {
  const std::string disc =
      "pattern: {panels: {disc: {vertices: [[-0.3, 0], [0.3, 0], [-0.1, 0], [0.1, 0]], edges: [{endpoints: "
      "[0, 1], "
      "curvature: {type: circle, params: [0.3, 0, 1]}}, {endpoints: [1, 0], curvature: {type: circle, "
      "params: [0.3, 0, "
      "1]}}, {endpoints: [2, 3], curvature: {type: circle, params: [0.1, 0, 1]}}, {endpoints: [3, 2], "
      "curvature: {type: "
      "circle, params: [0.1, 0, 1]}}]}}}";
  const TriangleMesh cloth = sewn(disc, 0.02);
  const auto polygon = [](double radius) {
    const double n = 2 * std::round(M_PI * radius / 0.02);
    return std::pair(n, n / 2 * radius * radius * std::sin(2 * M_PI / n));
  };
  const auto [outer, outer_area] = polygon(0.3);
  const auto [inner, inner_area] = polygon(0.1);
  CHECK(flat_area(cloth) == Approx(outer_area - inner_area).epsilon(1e-12));
  const Level level = Level::of(0, cloth);
  CHECK(std::ranges::count(level.topology.on_border, 1) == outer + inner);
  CHECK(check_mesh(cloth).empty());
  double least = 180;
  for (Eigen::Index t = 0; t < cloth.triangles.rows(); ++t) {
    const Eigen::Matrix3d x = rest_corners(cloth, t);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d a = x.col((k + 1) % 3) - x.col(k), b = x.col((k + 2) % 3) - x.col(k);
      CHECK(a.cross(b).z() > 0);
      least = std::min(least, std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI);
    }
  }
  CHECK(least > 25);
}

TEST_CASE("points on one line have no triangles, and segments that lie on one another are found") {
  const std::vector<Vector2d> points = {{0, 0}, {1, 0.5}, {2, 1}};
  const std::vector<std::array<int, 2>> sides = {{0, 1}, {1, 2}, {2, 0}};
  CHECK_THROWS_WITH(triangles_within(points, sides), Contains("sides of it cross"));
  CHECK((crossing_segments(points, sides, 1) == std::vector<std::array<int, 2>>{{0, 2}}));
}

TEST_CASE("a mirrored panel has a mirrored mesh") {
  const Polygon loop = {{0, 0}, {0.1, 0}, {0.2, 0}, {0.3, 0.05}, {0.3, 0.2}, {0.1, 0.3}, {0, 0.2}};
  Polygon mirrored;
  for (const Vector2d& p : loop) mirrored.insert(mirrored.begin(), Vector2d(0.7 - p.x(), p.y()));
  const TriangleMesh a = mesh_panel({loop}, 0.03), b = mesh_panel({mirrored}, 0.03);
  REQUIRE(a.vertices.rows() == b.vertices.rows());
  CHECK(area_vectors(a).col(2).minCoeff() > 0);
  CHECK(area_vectors(b).col(2).minCoeff() > 0);
  for (Eigen::Index v = 0; v < a.vertices.rows(); ++v) {
    const Eigen::RowVector3d p(0.7 - a.vertices(v, 0), a.vertices(v, 1), 0);
    CHECK((b.vertices.rowwise() - p).rowwise().norm().minCoeff() < 1e-12);
  }
  CHECK(a.triangles.rows() == b.triangles.rows());
}

TEST_CASE(
    "both sides of a seam have the edges of the longer one, and stitched vertices are one at the mean "
    "place") {
  const TriangleMesh bag = sewn(squares("{a: [front.left, back.left], b: [front.bottom, back.bottom], "
                                        "c: [front.right, back.right]}"),
                                0.02);
  CHECK(check_mesh(bag).empty());
  CHECK(check_pieces(bag).empty());
  const Level level = Level::of(0, bag);
  CHECK(std::ranges::count(level.topology.on_border, 1) == 20);  // the opening
  CHECK(flat_area(bag) == Approx(0.08).epsilon(1e-12));
  int seams = 0;
  for (int e = 0; e < level.topology.edges.rows(); ++e)
    if (is_seam(bag, level.topology, e)) {
      ++seams;
      for (const int v : level.topology.edges.row(e))
        CHECK(bag.vertices(v, 1) == Approx(-0.05));  // z of the file
    }
  CHECK(seams == 30);
  CHECK(bag.piece_names == std::vector<std::string>{"front", "back"});
  // A side of .21 m needs more edges than one of .2 m.
  const std::string eased =
      "pattern: {panels: {a: {vertices: [[0, 0], [0.2, 0], [0.2, 0.1]], edges: [[0, 1], [1, 2], [2, 0]]}, b: "
      "{translation: "
      "[0, 0, 1], vertices: [[0, 0], [0.23, 0], [0.23, 0.1]], edges: [[0, 1], [1, 2], [2, 0]]}}, stitches: "
      "[[{panel: a, "
      "edge: 0}, {panel: b, edge: 0}, right_wrong]]}";
  const TriangleMesh joined = sewn(eased, 0.02);
  const Level strip = Level::of(0, joined);
  seams = 0;
  for (int e = 0; e < strip.topology.edges.rows(); ++e) seams += is_seam(joined, strip.topology, e);
  CHECK(seams == 12);
}

TEST_CASE("an edge is sewn to several, and edges with darts are sewn past them") {
  const std::string skirt =
      "pattern:\n  panels:\n    left: {translation: [-0.2, 0, 0], vertices: [[0, 0], [0.2, 0], [0.2, 0.3], "
      "[0, 0.3]], edges: {hem: "
      "[0, 1], right: [1, 2], waist: [2, 3], left: [3, 0]}, darts: [{edge: waist, width: 0.03, depth: "
      "0.1}]}\n    right: "
      "{vertices: [[0, 0], [0.13, 0], [0.13, 0.3], [0, 0.3]], edges: {hem: [0, 1], right: [1, 2], waist: [2, "
      "3], left: [3, 0]}}\n"
      "    band: {translation: [-0.15, 0.32, 0], vertices: [[0, 0], [0.3, 0], [0.3, 0.04], [0, 0.04]], "
      "edges: {bottom: [0, 1], right: "
      "[1, 2], top: [2, 3], left: [3, 0]}}\n  stitches:\n    middle: [left.right, right.left]\n    waist: "
      "{sides: [[right.waist, "
      "left.waist], band.bottom], ease: 0.01}\n";
  const TriangleMesh cloth = sewn(skirt, 0.02);
  CHECK(check_mesh(cloth).empty());
  CHECK(check_pieces(cloth).empty());
  CHECK(flat_area(cloth) == Approx(0.2 * 0.3 - 0.03 * 0.1 / 2 + 0.13 * 0.3 + 0.3 * 0.04).epsilon(1e-12));
  const Level level = Level::of(0, cloth);
  // One border: hems, outer sides and the band's other three sides.
  double border = 0;
  for (int e = 0; e < level.topology.edges.rows(); ++e)
    if (level.topology.edge_triangles(e, 1) == -1) border += rest_length(cloth, level.topology, e);
  CHECK(border == Approx(0.2 + 0.13 + 0.3 + 0.3 + 0.3 + 2 * 0.04).epsilon(1e-12));
}

TEST_CASE("a tube of placed panels is the prism in space, on every level, with every energy") {
  constexpr int n = 9;
  constexpr double width = 0.07, apothem = width / 2 / 0.36397023426620234;  // over tan 20°
  std::string panels, stitches;
  for (int k = 0; k < n; ++k) {
    const double phi = 2 * M_PI * k / n, c = std::cos(phi), s = std::sin(phi);
    const std::string name = "p" + std::to_string(k), next = "p" + std::to_string((k + 1) % n);
    char placed[200];
    std::snprintf(placed, sizeof placed, "{translation: [%.17g, 0, %.17g], rotation: [0, %.17g, 0], ",
                  apothem * s - width / 2 * c, apothem * c + width / 2 * s, 360.0 * k / n);
    panels += "    " + name + ": " + placed +
              "vertices: [[0, 0], [0.07, 0], [0.07, 0.2], [0, 0.2]], edges: {hem: [0, 1], "
              "right: [1, 2], top: [2, 3], left: [3, 0]}}\n";
    stitches += "    s" + std::to_string(k) + ": [" + name + ".right, " + next + ".left]\n";
  }
  TriangleMesh tube = sewn("pattern:\n  panels:\n" + panels + "  stitches:\n" + stitches, 0.025),
               space = tube;
  tube.sewing->seam_angle = 2 * M_PI / n;
  space.sewing.reset();
  const auto refiner = make_plugin_from<Refiner>("midpoint");
  const std::vector<Level> flat = Hierarchy::of(tube, *refiner, 3).levels,
                           solid = Hierarchy::of(space, *refiner, 3).levels;
  for (int l = 0; l < 3; ++l)
    for (const auto* energies : {&sewn_membranes, &bending})
      for (const std::string& energy : *energies) {
        INFO(energy << ", level " << l);
        CHECK(energy_difference(energy, solid[l], flat[l]) < 1e-11);
      }
}

TEST_CASE("seams that give the cloth one side are refused, and right_wrong turns a panel over") {
  CHECK_THAT(
      refused_pattern(squares("{a: [front.left, back.left], b: [front.right, back.right, right_wrong]}")),
      Contains("seam b gives the cloth one side"));
  const TriangleMesh lining = sewn(squares("{a: [front.left, back.right, right_wrong]}"), 0.04);
  CHECK(check_mesh(lining).empty());
}

TEST_CASE("a panel may be cut at an angle: its warp is as it is drawn") {
  std::string text = squares("{a: [front.left, back.left]}");
  CHECK(sewn(text, 0.1).warp.rows() == 0);
  text.insert(text.find("translation:"), "grain: 30, ");
  const TriangleMesh cloth = sewn(text, 0.1);
  REQUIRE(cloth.warp.rows() == cloth.triangles.rows());
  for (Eigen::Index t = 0; t < cloth.warp.rows(); ++t) {
    const Eigen::RowVector3d drawn =
        cloth.piece[t] == 0 ? Eigen::RowVector3d(-0.5, std::sqrt(0.75), 0) : Eigen::RowVector3d(0, 1, 0);
    CHECK((cloth.warp.row(t) - drawn).norm() < 1e-15);
  }
}

TEST_CASE("labels name the edges that have them, by their two ends") {
  std::string text = squares("{a: [front.left, back.left]}");
  text.replace(text.find("top: [2, 3]"), 11, "top: {endpoints: [2, 3], label: rim}");
  ConfigErrors errors;
  LabelEdges labels;
  const auto cloth = sew_pattern(pattern_of(text), 0.05, errors, &labels);
  REQUIRE(cloth);
  REQUIRE(labels.size() == 1);
  CHECK(labels["rim"].size() == 8);
  double length = 0;
  for (std::size_t i = 0; i < labels["rim"].size(); i += 2)
    length +=
        (cloth->vertices.row(labels["rim"][i]) - cloth->vertices.row(labels["rim"][i + 1])).head<1>().norm();
  CHECK(length == Approx(0.2));
}

TEST_CASE("an opening of one edge stays open") {
  const TriangleMesh bag = sewn(squares("{a: [front.left, back.left], b: [front.bottom, back.bottom], "
                                        "c: [front.right, back.right]}"),
                                0.5);
  const Level level = Level::of(0, bag);
  CHECK(std::ranges::count(level.topology.on_border, 1) >= 3);
}
