// Folded, sewn and layered rest shapes come to rest on a floor with their layers apart.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "core/numerics/mesh_files/io.h"
#include "tests/support/closed_meshes.h"
#include "tests/support/command.h"
#include "tests/support/meshes.h"
#include "tests/support/slope.h"
#include "tests/support/solve.h"
#include "tests/support/strip.h"

using namespace drape;

namespace {

constexpr double degree = M_PI / 180;

// Rest shapes whose layers lie on each other, and starts in which the layers are apart. Lengths in metres.

/// A mesh at rest and where it starts.
struct LayeredShape {
  TriangleMesh rest;
  Positions start;
};

/// One straight part of a folded strip: its length, and its direction in the x-z plane as an angle from the
/// x axis at rest and at the start [rad].
struct Leaf {
  double length, rest, start;
};

/// A strip along y of this width that is folded between its leaves, in cells of about `spacing`.
LayeredShape folded(const std::vector<Leaf>& leaves, double width, double spacing) {
  std::vector<Eigen::Vector2d> rest{{0, 0}}, start{{0, 0}};
  const auto along = [](double angle) { return Eigen::Vector2d(std::cos(angle), std::sin(angle)); };
  for (const Leaf& leaf : leaves) {
    const int cells = std::max(1, static_cast<int>(std::lround(leaf.length / spacing)));
    for (int k = 0; k < cells; ++k) {
      rest.push_back(rest.back() + leaf.length / cells * along(leaf.rest));
      start.push_back(start.back() + leaf.length / cells * along(leaf.start));
    }
  }
  const int columns = static_cast<int>(rest.size()),
            rows = static_cast<int>(std::lround(width / spacing)) + 1;
  std::vector<Eigen::Vector3d> at_rest, at_start;
  std::vector<Eigen::Vector3i> triangles;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int v = i + columns * j;
      const double y = width * j / (rows - 1);
      at_rest.emplace_back(rest[i].x(), y, rest[i].y());
      at_start.emplace_back(start[i].x(), y, start[i].y());
      if (i + 1 == columns || j + 1 == rows) continue;
      triangles.emplace_back(v, v + 1, v + 1 + columns);
      triangles.emplace_back(v, v + 1 + columns, v + columns);
    }
  return {mesh_of(at_rest, triangles), mesh_of(at_start, {}).vertices};
}

/// Layers of the cells of one square grid in the x-y plane, sewn to each other at common vertices.
class Sewing {
 public:
  struct Layer {
    int columns, rows;                             ///< of cells
    std::function<bool(int i, int j)> has_cell;    ///< whether a cell is part of the layer
    std::function<bool(int i, int j)> is_joined;   ///< whether a vertex is the first layer's
    std::function<double(double x, double y)> up;  ///< height at the start
    bool faces_up = true;                          ///< layers that are joined face opposite ways
    double up_at_rest = 0;
  };

  explicit Sewing(double spacing) : spacing_(spacing) {}

  void add(const Layer& layer) {
    std::map<std::pair<int, int>, int> own;
    const bool is_first = first_.empty();
    const auto vertex = [&](int i, int j) {
      if (!is_first && layer.is_joined(i, j)) return first_.at({i, j});
      const auto [entry, is_new] = own.try_emplace({i, j}, static_cast<int>(rest_.size()));
      if (is_new) {
        rest_.emplace_back(i * spacing_, j * spacing_, layer.up_at_rest);
        start_.emplace_back(i * spacing_, j * spacing_, layer.up(i * spacing_, j * spacing_));
      }
      return entry->second;
    };
    const auto add_triangle = [&](int a, int b, int c) {
      layer.faces_up ? triangles_.emplace_back(a, b, c) : triangles_.emplace_back(a, c, b);
    };
    for (int j = 0; j < layer.rows; ++j)
      for (int i = 0; i < layer.columns; ++i) {
        if (!layer.has_cell(i, j)) continue;
        const int a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
        // A triangle whose vertices are all joined would be in both layers.
        const bool sewn_rising = layer.is_joined(i, j) && layer.is_joined(i + 1, j + 1) &&
                                 (layer.is_joined(i + 1, j) || layer.is_joined(i, j + 1));
        if (!sewn_rising) {
          add_triangle(a, b, c);
          add_triangle(a, c, d);
        } else {
          add_triangle(a, b, d);
          add_triangle(b, c, d);
        }
      }
    if (is_first) first_ = own;
  }

  LayeredShape shape() const { return {mesh_of(rest_, triangles_), mesh_of(start_, {}).vertices}; }

 private:
  double spacing_;
  std::vector<Eigen::Vector3d> rest_, start_;
  std::vector<Eigen::Vector3i> triangles_;
  std::map<std::pair<int, int>, int> first_;  // the first layer's vertices
};

/// Cotton that starts just above a floor, or `height` above it, with friction.
Solved scene_of(const LayeredShape& shape, const std::string& energies, const std::string& obstacle,
                double height) {
  const Scratch folder;
  const double up = height + 0.9 * dhat - shape.start.col(2).minCoeff();
  const auto write = [&](const std::string& file, Positions x) {
    x.col(2).array() += up;
    write_mesh(folder / file, {x, shape.rest.triangles});
    return "file: " + (folder / file).string() + "}";
  };
  return scene_from("name: layers\nlevels: 1\ncloth: {shape: file, " +
                    write("rest.obj", shape.rest.vertices) + "\nstart: {" + write("start.obj", shape.start) +
                    "\nmaterial: {density: 472.6, thickness: 3.18e-4, membrane_modulus: 8e4, "
                    "bending_modulus: 8e4, poisson_ratio: 0.243}\n"
                    "energies: [" +
                    energies +
                    "]\ncontact: [ipc, shapes]\nfriction: 0.3\n"
                    "obstacles: [{name: floor, shape: half_space}" +
                    obstacle + "]\nmethods: {newton: {}}\n");
}

/// A hinge's angle has no sign where its triangles lie on each other. So a shape is at rest opened by a
/// thousandth of its start where it has hinges, and as it is where it has none.
LayeredShape opened(LayeredShape shape) {
  shape.rest.vertices += 1e-3 * (shape.start - shape.rest.vertices);
  return shape;
}

/// The shape comes to rest, no higher than `top` above where it lies.
void check_rests(const char* name, const std::function<LayeredShape(double spacing)>& shape_of,
                 double top = 2 * dhat, const std::string& obstacle = "", double height = 0) {
  row("\n%s", name);
  row("%9s %8s %10s %12s %9s", "vertices", "hinges", "iterations", "smallest gap", "top");
  for (const double spacing : {0.01, 0.005})
    for (const bool hinges : {false, true}) {
      const LayeredShape shape = shape_of(spacing);
      Solved s = hinges ? scene_of(opened(shape), "neo_hookean, hinge, gravity", obstacle, height)
                        : scene_of(shape, "neo_hookean, gravity", obstacle, height);
      run_method(s);
      const LevelResult& r = s.levels.back();
      row("%9d %8s %10d %12.2e %9.2e", s.level().vertex_count(), hinges ? "yes" : "no", r.iterations,
          *r.smallest_gap, r.x.col(2).maxCoeff());
      CAPTURE(name, spacing, hinges, r.message);
      CHECK(has_converged(r.outcome));
      CHECK(*r.smallest_gap > dhat / 100);
      CHECK(r.x.col(2).maxCoeff() < top);
      for (const auto& contact : s.model().contacts()) CHECK(contact->intersections(r.x).empty());
    }
}

int cells(double length, double spacing) { return static_cast<int>(std::lround(length / spacing)); }
bool everywhere(int, int) { return true; }
bool nowhere(int, int) { return false; }
double lying(double, double) { return 0; }

/// A square of 8 cm with a sheet of 6 cm by 8 cm sewn to it at three sides, and a flap that is turned down.
LayeredShape bag(double spacing, bool has_flap) {
  const int n = cells(0.08, spacing), rows = cells(0.06, spacing);
  const auto seam = [&](int i, int j) { return j <= rows && (i == 0 || i == n || j == 0); };
  Sewing bag(spacing);
  bag.add({n, n, everywhere, seam, lying});
  bag.add({n, rows, everywhere, seam,
           [](double x, double y) { return 5e-4 * std::sin(M_PI * x / 0.08) * std::min(1.0, y / 0.02); },
           false});
  if (has_flap)
    bag.add({n, n, [&](int, int j) { return j >= n / 2; }, [&](int, int j) { return j == n; },
             [](double, double y) { return 0.1 * (0.08 - y); }, false});
  return bag.shape();
}

/// Two layers of an L that are sewn together but at the leg's end.
LayeredShape sock(double spacing) {
  const int foot = cells(0.08, spacing), leg = cells(0.12, spacing), width = cells(0.04, spacing);
  const auto inside = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < foot && j < leg && (i < width || j < width);
  };
  const auto seam = [&](int i, int j) {
    const int around = inside(i, j) + inside(i - 1, j) + inside(i, j - 1) + inside(i - 1, j - 1);
    return around < 4 && !(j == leg && around == 2);
  };
  const auto bulge = [](double x, double y) {
    const auto along = [](double a, double b) {  // a strip from a = 0, closed there and at its sides
      return b < 0.04 ? std::sin(M_PI * b / 0.04) * std::min(1.0, a / 0.04) : 0;
    };
    return 1e-3 * std::max(along(y, x), std::min(along(x, y), along(0.08 - x, y)));
  };
  Sewing sock(spacing);
  sock.add({foot, leg, inside, seam, lying});
  sock.add({foot, leg, inside, seam, bulge, false});
  return sock.shape();
}

}  // namespace

TEST_CASE("Folded strips rest with their layers apart", "[physics]") {
  check_rests("hem", [](double spacing) {
    const double up = M_PI - std::asin(3e-4 / spacing);
    return folded({{0.1, 0, 0}, {spacing, up, up}, {0.03 - spacing, M_PI, M_PI}}, 0.08, spacing);
  });
  struct Strip {
    const char* name;
    double width;
    std::vector<Leaf> leaves;
  };
  const Strip strips[] = {
      {"sharp pleat", 0.08, {{0.06, 0, 0}, {0.03, M_PI, M_PI - 2 * degree}, {0.06, 0, 2 * degree}}},
      {"box pleat",
       0.06,
       {{0.05, 0, 0},
        {0.02, M_PI, M_PI + 2 * degree},
        {0.042, 0, 0},
        {0.02, M_PI, M_PI - 2 * degree},
        {0.05, 0, 0}}},
      {"letter", 0.06, {{0.06, M_PI, M_PI + 6 * degree}, {0.06, 0, 0}, {0.04, M_PI, M_PI - degree}}},
      {"book that is shut at rest", 0.08, {{0.08, M_PI, M_PI}, {0.08, 0, 20 * degree}}}};
  for (const Strip& strip : strips)
    check_rests(strip.name, [&](double spacing) { return folded(strip.leaves, strip.width, spacing); });
}

TEST_CASE("Layers that are sewn together rest apart", "[physics]") {
  check_rests("pocket", [](double spacing) { return bag(spacing, false); });
  check_rests("envelope with a flap", [](double spacing) { return bag(spacing, true); });
  check_rests("sock", sock);
  check_rests("cushion without pressure", [](double spacing) {
    const int rings = cells(0.05, spacing);
    const auto disc = [&](double bulge) { return cushion_mesh(0.05, 6 * rings, rings, bulge); };
    return LayeredShape{disc(0), disc(5e-4).vertices};
  });
}

TEST_CASE("Two coats rest on a ball and the floor with their layers apart", "[physics]") {
  check_rests(
      "two coats",
      [](double spacing) {
        const int n = cells(0.1, spacing);
        Sewing coats(spacing);
        coats.add({n, n, everywhere, nowhere, lying});
        coats.add({n, n, everywhere, nowhere, [](double, double) { return 2e-4; }, true, 2e-4});
        return coats.shape();
      },
      0.02 + 2 * dhat, ", {name: ball, shape: sphere, radius: 0.03, translate: [0.05, 0.05, -0.01]}", 0.02);
}
