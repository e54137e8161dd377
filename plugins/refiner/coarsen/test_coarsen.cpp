#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "core/numerics/elements/scaled_energy.h"
#include "core/numerics/hierarchy/fineness.h"
#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/mesh/check.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/meshes.h"
#include "tests/support/registry.h"
#include "tests/support/sewn.h"

using namespace drape;

namespace {

Hierarchy coarsened(const TriangleMesh& mesh, int levels, const std::string& plugin = "coarsen") {
  return Hierarchy::of(mesh, *make_plugin_from<Refiner>(plugin), 1, levels);
}

/// The smallest angle of a level's triangles at rest [degree].
double smallest_angle(const Level& level) {
  double smallest = 180;
  for (int t = 0; t < level.triangle_count(); ++t) {
    const Eigen::Matrix3d x = rest_corners(level.rest, t);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d a = x.col((k + 1) % 3) - x.col(k), b = x.col((k + 2) % 3) - x.col(k);
      smallest = std::min(smallest, std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI);
    }
  }
  return smallest;
}

/// What holds for the operators and indices of every coarsened hierarchy.
void check_operators(const Hierarchy& hierarchy) {
  const Level& cloth = hierarchy.levels[hierarchy.cloth];
  for (int l = 0; l < hierarchy.cloth; ++l) {
    const Level &coarse = hierarchy.levels[l], &fine = hierarchy.levels[l + 1];
    CHECK(check_mesh(coarse.rest).empty());
    CHECK(coarse.index == l);
    const Eigen::VectorXd sums = hierarchy.linear[l] * Eigen::VectorXd::Ones(coarse.vertex_count());
    CHECK((sums.array() - 1).abs().maxCoeff() <= 1e-14);
    CHECK(coarse.rest.vertices == cloth.rest.vertices(coarse.cloth_vertices, Eigen::all));
    for (int v = 0; v < coarse.vertex_count(); ++v) {
      const int same = fine.own_vertex(coarse.cloth_vertices[v]);
      CHECK(coarse.own_vertices[coarse.cloth_vertices[v]] == v);
      CHECK(hierarchy.linear[l].coeff(same, v) == 1);
    }
  }
}

/// A rectangle whose sides x = 0 and x = 1 are sewn to each other, placed as a tube along y.
TriangleMesh sleeve(int columns, int rows) {
  TriangleMesh mesh = as_piece(grid({1, 0.8}, columns, rows, Diagonals::criss_cross));
  Positions x((columns - 1) * rows, 3);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns - 1; ++i) {
      const double angle = 2 * M_PI * i / (columns - 1);
      x.row(i + (columns - 1) * j) << std::cos(angle) / (2 * M_PI), mesh.vertices(columns * j, 1),
          -std::sin(angle) / (2 * M_PI);
    }
  mesh.vertices = x;
  for (int& v : mesh.triangles.reshaped()) v = v % columns % (columns - 1) + (columns - 1) * (v / columns);
  return mesh;
}

/// A cup of 6 cm with a flat brim.
TriangleMesh moulded_cup(int vertices) {
  return shaped_disc(vertices, [](double r) {
    return Eigen::Vector2d(.1 * r, r < .7 ? .06 * std::pow(std::cos(r / .7 * M_PI / 2), 2) : 0);
  });
}

/// The upper end of a sleeve: half a tube whose end is cut along a wave.
TriangleMesh sleeve_cap(int vertices) {
  TriangleMesh mesh = random_triangulation({1, 1}, vertices, 3);
  for (auto x : mesh.vertices.rowwise()) {
    const double angle = M_PI * x[0];
    x = Eigen::RowVector3d(.08 * std::cos(angle), .2 * x[1] * (1 + .4 * std::sin(angle)),
                           .08 * std::sin(angle));
  }
  return mesh;
}

/// A ball of radius 1, whose vertices are on none of a coarser one's edges.
TriangleMesh closed_ball() {
  TriangleMesh mesh = unit_sphere(4);
  for (auto x : mesh.vertices.rowwise()) x[2] *= 1 + .1 * x[0];
  return mesh;
}

TriangleMesh sleeve_without_pieces() {
  TriangleMesh mesh = sleeve(40, 31);
  mesh.sewing.reset();
  return mesh;
}

const Polygon outline{{0, 0}, {1, 0}, {1, .4}, {.4, .4}, {.4, 1}, {0, 1}};

}  // namespace

TEST_CASE("Coarser levels share vertices and reproduce linear functions of a flat cloth") {
  Polygon hole;
  for (int k = 0; k < 24; ++k)
    hole.emplace_back(.2 + .1 * std::cos(k * M_PI / 12), .2 + .1 * std::sin(k * M_PI / 12));
  TriangleMesh tilted = random_triangulation({1, 0.6}, 1500, 4);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  tilted.vertices *= turn.transpose();
  for (const TriangleMesh& mesh : {random_triangulation({1, 1}, 2000, 1), disc(0.5, 2000),
                                   delaunay_polygon({outline, hole}, 2500, 1), tilted}) {
    const Hierarchy hierarchy = coarsened(mesh, 2);
    check_operators(hierarchy);
    for (int l = 0; l < 2; ++l) {
      const Level &coarse = hierarchy.levels[l], &fine = hierarchy.levels[l + 1];
      const double ratio = static_cast<double>(fine.vertex_count()) / coarse.vertex_count();
      CHECK(ratio > 3);
      CHECK(ratio < 4.8);
      CHECK(smallest_angle(coarse) > 12);
      CHECK((hierarchy.linear[l] * coarse.rest.vertices - fine.rest.vertices).cwiseAbs().maxCoeff() < 1e-12);
    }
    CHECK(hierarchy.levels[2].rest.triangles == mesh.triangles);
    CHECK(hierarchy.levels[2].rest.vertices == mesh.vertices);
  }
}

TEST_CASE("Straight outlines keep their area, corners and holes") {
  const Hierarchy hierarchy = coarsened(delaunay_polygon({outline}, 3000, 1), 3);
  for (const Level& level : hierarchy.levels) {
    CHECK(level.vertex_area.sum() == Approx(0.64).epsilon(1e-12));
    for (const Eigen::Vector2d& corner : outline)
      CHECK((level.rest.vertices.leftCols<2>().rowwise() - corner.transpose()).rowwise().norm().minCoeff() ==
            0);
  }
}

TEST_CASE("A sleeve keeps its seam and at least three edges of its cuffs") {
  const TriangleMesh mesh = sleeve(41, 33);
  REQUIRE(check_mesh(mesh).empty());
  REQUIRE(check_pieces(mesh).empty());
  const Hierarchy hierarchy = coarsened(mesh, 3);
  check_operators(hierarchy);
  for (const Level& level : hierarchy.levels) {
    CHECK(check_pieces(level.rest).empty());
    CHECK(level.vertex_area.sum() == Approx(0.8).epsilon(1e-12));
    const auto borders = std::ranges::count(level.topology.on_border, 1);
    CHECK(borders >= 6);
    if (level.index == 0) CHECK(borders < 20);
  }
  // The height along the tube is linear in the pattern and has one value at the seam.
  for (int l = 0; l < 3; ++l) {
    const Eigen::VectorXd up = hierarchy.levels[l].rest.vertices.col(1);
    CHECK((hierarchy.linear[l] * up - hierarchy.levels[l + 1].rest.vertices.col(1)).cwiseAbs().maxCoeff() <
          1e-12);
  }
}

TEST_CASE("A level of small or few pieces keeps what they need") {
  // Two panels that are sewn along both sides, as a pillow's.
  TriangleMesh panel = as_piece(grid({0.3, 0.2}, 13, 9, Diagonals::criss_cross)), pillow = panel;
  const Eigen::Index n = panel.vertices.rows(), m = panel.triangles.rows();
  std::vector<int> back(n);
  pillow.vertices.conservativeResize(2 * n, 3);
  const Level level = Level::of(0, panel);
  int next = static_cast<int>(n);
  for (int v = 0; v < n; ++v) {
    back[v] = level.topology.on_border[v] ? v : next;
    if (back[v] == next)
      pillow.vertices.row(next++) = panel.vertices.row(v) + Eigen::RowVector3d(0, 0, -0.05);
  }
  pillow.vertices.conservativeResize(next, 3);
  pillow.triangles.conservativeResize(2 * m, 3);
  pillow.uv.conservativeResize(2 * m, 6);
  for (Eigen::Index t = 0; t < m; ++t)
    for (int k = 0; k < 3; ++k) {
      pillow.triangles(m + t, k) = back[panel.triangles(t, 2 - k)];
      pillow.uv.block<1, 2>(m + t, 2 * k) = panel.uv.block<1, 2>(t, 2 * (2 - k)) + Eigen::RowVector2d(1, 0);
    }
  REQUIRE(check_mesh(pillow).empty());
  const Hierarchy hierarchy = coarsened(pillow, 2);
  check_operators(hierarchy);
  CHECK(hierarchy.levels[0].vertex_area.sum() == Approx(2 * 0.3 * 0.2).epsilon(1e-12));
}

TEST_CASE("How much finer the finest level is, by the operators") {
  const Hierarchy regular =
      Hierarchy::of(random_triangulation({1, 1}, 200, 1), *make_plugin_from<Refiner>("loop"), 3);
  CHECK(Fineness::of(regular, 0).levels == 2);
  CHECK(Fineness::of(regular, 0).areas.size() == 0);
  const Hierarchy hierarchy = coarsened(random_triangulation({1, 1}, 4000, 1), 2);
  for (int l = 0; l < 2; ++l) {
    const Fineness fineness = Fineness::of(hierarchy, l);
    CHECK(fineness.levels == Approx(2 - l).epsilon(0.15));
    CHECK(fineness.areas.minCoeff() > 0.3 * std::pow(4, -fineness.levels));
    CHECK(fineness.areas.maxCoeff() < 6 * std::pow(4, -fineness.levels));
    const Eigen::VectorXd lengths = fineness.relative_lengths(hierarchy.levels[l]);
    CHECK(lengths.array().log().mean() == Approx(0).margin(0.05));
  }
}

TEST_CASE("A mesh that splits another one's triangles has that one below it, whatever its order") {
  TriangleMesh with_hole =
      delaunay_polygon({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{.3, .3}, {.3, .5}, {.5, .5}, {.5, .3}}}, 150, 1);
  for (const TriangleMesh& former :
       {random_triangulation({1, 1}, 200, 1), with_hole, grid({1, 0.8}, 11, 9, Diagonals::one_way),
        as_piece(random_triangulation({1, 1}, 100, 2))}) {
    const Hierarchy split = Hierarchy::of(former, *make_plugin_from<Refiner>("midpoint"), 3);
    TriangleMesh fine = split.levels[2].rest;
    const auto m = fine.triangles.rows(), n = fine.vertices.rows();
    const auto turned = [](Eigen::Index i, Eigen::Index count) { return (i * 7919 + 13) % count; };
    const TriangleMesh before = fine;
    for (Eigen::Index v = 0; v < n; ++v) fine.vertices.row(turned(v, n)) = before.vertices.row(v);
    for (Eigen::Index t = 0; t < m; ++t) {
      for (int k = 0; k < 3; ++k)
        fine.triangles(turned(t, m), k) = static_cast<int>(turned(before.triangles(t, k), n));
      if (fine.uv.rows() > 0) fine.uv.row(turned(t, m)) = before.uv.row(t);
    }
    REQUIRE(check_mesh(fine).empty());
    const Hierarchy hierarchy = coarsened(fine, 2);
    check_operators(hierarchy);
    for (int l = 0; l < 2; ++l) {
      const Level& level = hierarchy.levels[l];
      CHECK(level.vertex_count() == split.levels[l].vertex_count());
      CHECK(level.triangle_count() == split.levels[l].triangle_count());
      CHECK((hierarchy.linear[l] * level.rest.vertices - hierarchy.levels[l + 1].rest.vertices)
                .cwiseAbs()
                .maxCoeff() < 1e-14);
      const Fineness fineness = Fineness::of(hierarchy, l);
      CHECK(fineness.levels == 2 - l);
      CHECK(fineness.areas.size() == 0);  // as on levels that drape refines
    }
  }
}

TEST_CASE("A coarse level resists bending in each direction as the finest mesh does") {
  // Odd numbers of cells: not the refinement of another grid.
  const Hierarchy hierarchy = coarsened(grid({1, 1}, 62, 62, Diagonals::one_way), 2);
  const auto hinge = make_plugin_from<Energy>("hinge");
  const auto bind = [&](const Level& own) { return hinge->bind(own, {}); };
  const auto bent = [&](const Level& level, const Eigen::Vector2d& across, const Eigen::VectorXd& factors) {
    Positions x = level.rest.vertices;
    for (Eigen::Index v = 0; v < x.rows(); ++v)
      x(v, 2) = 5e-4 * std::pow(across.dot(x.row(v).head<2>().transpose()), 2);
    return bind_with_seams(level, bind, factors)->value(x);
  };
  for (int l = 0; l < 2; ++l) {
    const Level& level = hierarchy.levels[l];
    const Eigen::VectorXd folds = Fineness::of(hierarchy, l).folds;
    double before = 0;
    for (const Eigen::Vector2d& across :
         {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1), Eigen::Vector2d(1, 1).normalized(),
          Eigen::Vector2d(1, -1).normalized()}) {
      const double wanted = bent(hierarchy.levels[2], across, {});
      before = std::max(before, std::abs(std::log(bent(level, across, {}) / wanted)));
      CHECK(bent(level, across, folds) / wanted == Approx(1).margin(0.3));
    }
    CHECK(before > std::log(2));
  }
}

TEST_CASE("A curved rest shape is given back by linear interpolation and offsets along coarse normals") {
  for (const TriangleMesh& mesh :
       {hemisphere(3000), moulded_cup(3000), sleeve_cap(3000), closed_ball(), sleeve_without_pieces()}) {
    const Hierarchy hierarchy = coarsened(mesh, 2);
    check_operators(hierarchy);
    CHECK(hierarchy.levels[2].rest.triangles == mesh.triangles);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    for (int l = 0; l < 2; ++l) {
      const Level &coarse = hierarchy.levels[l], &fine = hierarchy.levels[l + 1];
      const double ratio = static_cast<double>(fine.vertex_count()) / coarse.vertex_count();
      CHECK(ratio == Approx(4).epsilon(0.02));
      CHECK(smallest_angle(coarse) > 12);
      CHECK(hierarchy.linear[l].coeffs().minCoeff() > -0.5);
      CHECK(hierarchy.offsets[l].height.cwiseAbs().maxCoeff() <
            0.5 * std::sqrt(2 * coarse.vertex_area.sum() / coarse.triangle_count()));
      // Moved as a whole.
      const auto moved = [&](const Level& level) {
        return Positions((level.rest.vertices * turn).rowwise() + Eigen::RowVector3d(.1, -.2, .3));
      };
      const Positions found = hierarchy.prolong(moved(coarse), l, l + 1, hierarchy.linear);
      CHECK((found - moved(fine)).cwiseAbs().maxCoeff() < 1e-12);
    }
    CHECK((hierarchy.prolong(hierarchy.levels[0].rest.vertices, 0, 2, hierarchy.linear) - mesh.vertices)
              .cwiseAbs()
              .maxCoeff() < 1e-12);
  }
}

TEST_CASE("Forces on vertices beside coarse triangles are derivatives of what is done on them") {
  const Hierarchy hierarchy = coarsened(hemisphere(400), 1);
  const Triangles& triangles = hierarchy.levels[0].rest.triangles;
  Positions x = hierarchy.levels[0].rest.vertices;
  for (auto p : x.rowwise()) p[2] *= 1 + 2 * p[0], p[0] += .3 * p[1] * p[1];
  const Positions f = hierarchy.levels[1].rest.vertices.array().sin();
  const auto work = [&](const Positions& at) {
    return f.cwiseProduct(hierarchy.prolong(at, 0, 1, hierarchy.linear)).sum();
  };
  Positions forces = hierarchy.linear[0].transpose() * f;
  hierarchy.offsets[0].add_forces(triangles, x, f, forces);
  constexpr double step = 1e-6;
  double worst = 0;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    Positions a = x, b = x;
    a.data()[k] -= step, b.data()[k] += step;
    worst = std::max(worst, std::abs((work(b) - work(a)) / (2 * step) - forces.data()[k]));
  }
  CHECK(worst < 1e-7 * forces.cwiseAbs().maxCoeff());
}

TEST_CASE("What cannot be coarsened is refused") {
  CHECK_THROWS_WITH(coarsened(grid({1, 1}, 2, 2, Diagonals::one_way), 1),
                    Catch::Contains("has no vertex that its"));
  CHECK_THROWS_WITH(coarsened(random_triangulation({1, 1}, 300, 1), 1, "loop"),
                    Catch::Contains("write \"refiner: coarsen\""));
}
