// Folded, sewn and layered rest shapes come to rest on a floor with their layers apart.

#include <functional>
#include <map>

#include "core/numerics/mesh_files/io.h"
#include "tests/support/closed_meshes.h"
#include "tests/support/known_answers.h"
#include "tests/support/meshes.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

constexpr double degree = M_PI / 180, reach = 1e-3;  // of the contact, its dhat [m]

int cells(double length, double spacing) { return static_cast<int>(std::lround(length / spacing)); }

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
  std::vector<Eigen::RowVector2d> rest{{0, 0}}, start{{0, 0}};  // x and z
  const auto along = [](double angle) { return Eigen::RowVector2d(std::cos(angle), std::sin(angle)); };
  for (const Leaf& leaf : leaves) {
    const int n = std::max(1, cells(leaf.length, spacing));
    for (int k = 0; k < n; ++k) {
      rest.push_back(rest.back() + leaf.length / n * along(leaf.rest));
      start.push_back(start.back() + leaf.length / n * along(leaf.start));
    }
  }
  const int columns = static_cast<int>(rest.size());
  const TriangleMesh flat = grid({1, width}, columns, cells(width, spacing) + 1, Diagonals::one_way);
  LayeredShape shape{flat, flat.vertices};
  for (Eigen::Index v = 0; v < flat.vertices.rows(); ++v)
    for (const int c : {0, 1}) {
      shape.rest.vertices(v, 2 * c) = rest[v % columns][c];
      shape.start(v, 2 * c) = start[v % columns][c];
    }
  return shape;
}

/// Layers of cells of one square grid in the x-y plane, sewn to each other at common vertices. The first
/// layer faces up, the others down.
class Sewing {
 public:
  using OfGrid = std::function<bool(int i, int j)>;

  Sewing(double spacing, int columns, int rows) : spacing_(spacing), columns_(columns), rows_(rows) {}

  /// A layer of some cells, which has the first layer's vertices where it is joined, `up` above them
  /// elsewhere.
  void add(const OfGrid& has_cell, const OfGrid& is_joined, double (*up)(double x, double y)) {
    std::map<std::pair<int, int>, int> own;
    const bool is_first = first_.empty();
    const auto vertex = [&](int i, int j) {
      if (!is_first && is_joined(i, j)) return first_.at({i, j});
      const auto [entry, is_new] = own.try_emplace({i, j}, static_cast<int>(rest_.size()));
      const double x = i * spacing_, y = j * spacing_;
      if (is_new) rest_.emplace_back(x, y, 0), start_.emplace_back(x, y, up(x, y));
      return entry->second;
    };
    const auto add_triangle = [&](int a, int b, int c) {
      is_first ? triangles_.emplace_back(a, b, c) : triangles_.emplace_back(a, c, b);
    };
    for (int j = 0; j < rows_; ++j)
      for (int i = 0; i < columns_; ++i) {
        if (!has_cell(i, j)) continue;
        const int a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
        // A triangle whose vertices are all joined would be in both layers.
        const bool sewn_rising =
            is_joined(i, j) && is_joined(i + 1, j + 1) && (is_joined(i + 1, j) || is_joined(i, j + 1));
        add_triangle(a, b, sewn_rising ? d : c);
        add_triangle(sewn_rising ? b : a, c, d);
      }
    if (is_first) first_ = own;
  }

  LayeredShape shape() const { return {mesh_of(rest_, triangles_), mesh_of(start_, {}).vertices}; }

 private:
  double spacing_;
  int columns_, rows_;
  std::vector<Eigen::Vector3d> rest_, start_;
  std::vector<Eigen::Vector3i> triangles_;
  std::map<std::pair<int, int>, int> first_;  // the first layer's vertices
};

/// Cotton at rest, with friction, from a start just above a floor, or `height` above it. A hinge's angle has
/// no sign where its triangles lie on each other. So a shape is at rest opened by a thousandth of its start
/// where it has hinges, and as it is where it has none.
Solved at_rest(const LayeredShape& shape, bool hinges, const std::string& obstacle, double height) {
  const Scratch folder;
  const double up = height + 0.9 * reach - shape.start.col(2).minCoeff();
  const auto write = [&](const std::string& file, Positions x) {
    x.col(2).array() += up;
    write_mesh(folder / file, {x, shape.rest.triangles});
    return (folder / file).string();
  };
  const Positions& rest = shape.rest.vertices;
  return solve_yaml(
      experiment(R"(cloth: {shape: file, file: $}
start: {file: $}
energies: [neo_hookean, $gravity]
contact: [ipc, shapes]
friction: 0.3
obstacles: [{name: floor, shape: half_space}$]
)",
                 write("rest.obj", hinges ? Positions(rest + 1e-3 * (shape.start - rest)) : rest),
                 write("start.obj", shape.start), hinges ? "hinge, " : "", obstacle));
}

/// The shape comes to rest, no higher than `top` above where it lies.
void check_rests(const char* name, const std::function<LayeredShape(double spacing)>& shape_of,
                 double top = 2 * reach, const std::string& obstacle = "", double height = 0) {
  for (const double spacing : {0.01, 0.005})
    for (const bool hinges : {false, true}) {
      const Solved s = at_rest(shape_of(spacing), hinges, obstacle, height);
      const LevelResult& r = s.levels.back();
      CAPTURE(name, spacing, hinges, r.message);
      CHECK(has_converged(r.outcome));
      CHECK(*r.smallest_gap > reach / 100);
      CHECK(r.x.col(2).maxCoeff() < top);
      for (const auto& contact : s.model().contacts()) CHECK(contact->intersections(r.x).empty());
    }
}

double lying(double, double) { return 0; }

/// A square of 8 cm with a sheet of 6 cm by 8 cm sewn to it at three sides, and a flap that is turned down.
LayeredShape bag(double spacing, bool has_flap) {
  const int n = cells(0.08, spacing), rows = cells(0.06, spacing);
  const auto seam = [&](int i, int j) { return j <= rows && (i == 0 || i == n || j == 0); };
  Sewing bag(spacing, n, n);
  bag.add([](int, int) { return true; }, seam, lying);
  bag.add([&](int, int j) { return j < rows; }, seam,
          [](double x, double y) { return 5e-4 * std::sin(M_PI * x / 0.08) * std::min(1.0, y / 0.02); });
  if (has_flap)
    bag.add([&](int, int j) { return j >= n / 2; }, [&](int, int j) { return j == n; },
            [](double, double y) { return 0.1 * (0.08 - y); });
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
  Sewing sock(spacing, foot, leg);
  sock.add(inside, seam, lying);
  sock.add(inside, seam, bulge);
  return sock.shape();
}

}  // namespace

TEST_CASE("Folded strips rest with their layers apart") {
  const auto check = [](const char* name, double width, const std::vector<Leaf>& leaves) {
    check_rests(name, [&](double spacing) { return folded(leaves, width, spacing); });
  };
  check("sharp pleat", 0.08, {{0.06, 0, 0}, {0.03, M_PI, M_PI - 2 * degree}, {0.06, 0, 2 * degree}});
  const Leaf falling{0.02, M_PI, M_PI + 2 * degree}, rising{0.02, M_PI, M_PI - 2 * degree};
  check("box pleat", 0.06, {{0.05, 0, 0}, falling, {0.042, 0, 0}, rising, {0.05, 0, 0}});
  check("letter", 0.06, {{0.06, M_PI, M_PI + 6 * degree}, {0.06, 0, 0}, {0.04, M_PI, M_PI - degree}});
  check("book that is shut at rest", 0.08, {{0.08, M_PI, M_PI}, {0.08, 0, 20 * degree}});
  check_rests("hem", [](double spacing) {
    const double up = M_PI - std::asin(3e-4 / spacing);
    return folded({{0.1, 0, 0}, {spacing, up, up}, {0.03 - spacing, M_PI, M_PI}}, 0.08, spacing);
  });
}

TEST_CASE("Layers that are sewn together rest apart") {
  check_rests("pocket", [](double spacing) { return bag(spacing, false); });
  check_rests("envelope with a flap", [](double spacing) { return bag(spacing, true); });
  check_rests("sock", sock);
  check_rests("cushion without pressure", [](double spacing) {
    const int rings = cells(0.05, spacing);
    const auto disc = [&](double bulge) { return cushion_mesh(0.05, 6 * rings, rings, bulge); };
    return LayeredShape{disc(0), disc(5e-4).vertices};
  });
}

TEST_CASE("Two coats rest on a ball and the floor with their layers apart") {
  const auto coats = [](double spacing) {
    const int n = cells(0.1, spacing) + 1;
    const TriangleMesh coat = grid({0.1, 0.1}, n, n, Diagonals::one_way);
    const TriangleMesh both = both_of(coat, coat, {0, 0, 2e-4});
    return LayeredShape{both, both.vertices};
  };
  check_rests("two coats", coats, 0.02 + 2 * reach,
              ", {name: ball, shape: sphere, radius: 0.03, translate: [0.05, 0.05, -0.01]}", 0.02);
}
