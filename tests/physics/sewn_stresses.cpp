// Stresses of cloth of flat pieces: seams of two lengths, warp that follows the piece, pressed seams.

#include "core/numerics/elements/scaled_energy.h"
#include "core/numerics/elements/stretch.h"
#include "core/numerics/elements/vertex_fields.h"
#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/hierarchy/midpoint.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/refusal.h"
#include "tests/support/sewn.h"
#include "tests/support/strip.h"

using namespace drape;

namespace {

Material cloth_of_tests() {
  Material material;
  material.poisson_ratio = 0.3;
  material.warp_stiffness = 3000, material.weft_stiffness = 900, material.shear_stiffness = 60;
  material.warp_bending = 1e-5, material.weft_bending = 4e-6, material.bias_bending = 3e-6;
  return material;
}

}  // namespace

TEST_CASE(
    "Strips of lengths 1 and 1.05 that are sewn share one length, with the stresses of the closed form") {
  constexpr double eased = 1.05, width = 0.1, stiffness = 2000;
  TriangleMesh mesh = as_piece(grid({1, 2 * width}, 21, 9, Diagonals::criss_cross));
  for (Eigen::Index t = 0; t < mesh.uv.rows(); ++t)
    if (mesh.vertices(mesh.triangles.row(t), 1).mean() > width)
      for (int k = 0; k < 3; ++k) mesh.uv(t, 2 * k) *= eased;
  const bool woven = GENERATE(false, true);
  Material material;
  material.thickness = 1e-3, material.membrane_modulus = stiffness / material.thickness,
  material.poisson_ratio = 0;
  if (woven) {
    material.warp_stiffness = stiffness, material.weft_stiffness = 500, material.shear_stiffness = 60;
    mesh.warp = cut_directions(mesh, GrainAxis::u, 0);
  }
  const Level level = Level::of(0, mesh);
  // Without Poisson's ratio a strip has ½ E d g² of its rest area, g = (λ² - 1) / 2. Forces cancel at L.
  const auto force = [&](double l) {
    return width * stiffness * (l * (l * l - 1) / 2 + l / eased * (l * l / (eased * eased) - 1) / 2);
  };
  double length = 1.02;
  for (int i = 0; i < 50; ++i)
    length -= force(length) / ((force(length + 1e-6) - force(length - 1e-6)) / 2e-6);
  Positions x = mesh.vertices;
  x.col(0) *= length;
  const auto energy = make_plugin_from<Energy>(woven ? "woven" : "stvk")->bind(level, material);
  const Positions g = gradient_of(*energy, x);
  double ends[2] = {0, 0}, loose = 0;
  for (int v = 0; v < level.vertex_count(); ++v)
    if (mesh.vertices(v, 0) > 1 - 1e-9)
      ends[mesh.vertices(v, 1) > width + 1e-9] += g(v, 0);  // the seam's end belongs to both
    else if (mesh.vertices(v, 0) > 1e-9)
      loose = std::max(loose, g.row(v).norm());
  const double scale = width * stiffness * 0.02;
  CHECK(std::abs(ends[0] + ends[1]) < 1e-6 * scale);
  CHECK(loose < 1e-9 * scale);
  for (int t = 0; t < level.triangle_count(); ++t) {
    const auto v = level.rest.triangles.row(t);
    const PrincipalStretch<double> stretch =
        RestTriangle::of(level, t).stretch(x.row(v[1]) - x.row(v[0]), x.row(v[2]) - x.row(v[0]));
    const bool longer = mesh.vertices(v, 1).mean() > width;
    CHECK((longer ? stretch.smallest : stretch.largest) ==
          Approx(longer ? length / eased : length).epsilon(1e-12));
  }
  const double of_one = stiffness / 2 * std::pow((length * length - 1) / 2, 2) * width,
               of_other =
                   stiffness / 2 * std::pow((length * length / eased / eased - 1) / 2, 2) * width * eased;
  CHECK(energy->value(x) == Approx(of_one + of_other).epsilon(1e-12));
}

TEST_CASE("Warp follows the piece: woven cloth cut at 30 degrees is the piece turned by that angle") {
  const Material material = cloth_of_tests();
  TriangleMesh strip = triangulated("criss_cross", {0.3, 0.06}, Eigen::Vector2i(12, 3));
  TriangleMesh turned = as_piece(strip), cut = turned, sewn = turned;
  strip.warp = warp_at(strip, 30);
  const std::vector<char> all(strip.triangles.rows(), 1);
  place_piece(turned, all, 60, false, {0.1, 0.2});  // what lies at 30° lies along y then
  cut.warp = cut_directions(cut, GrainAxis::x, -60);
  // Two pieces, of which one is turned.
  std::vector<char> part(all.size());
  for (std::size_t t = 0; t < part.size(); ++t) part[t] = strip.vertices(strip.triangles(t, 0), 0) > 0.15;
  place_piece(sewn, all, 60, false, {0, 0});
  place_piece(sewn, part, 0, false, {1, 1});
  const Level level = Level::of(0, strip);
  for (const std::string energy : {"woven", "midedge_bending"}) {
    INFO(energy);
    for (const TriangleMesh* piece : {&turned, &cut, &sewn})
      CHECK(energy_difference(energy, level, Level::of(0, *piece), material) < 1e-11);
    TriangleMesh along_y = as_piece(strip);
    along_y.warp.resize(0, 3);
    CHECK(energy_difference(energy, level, Level::of(0, along_y), material) > 1e-3);
  }
}

TEST_CASE("A pressed seam is stiffer by its factor, in every bending energy") {
  const TriangleMesh whole = grid({0.2, 0.1}, 3, 2, Diagonals::one_way);  // one inner fold that is a seam
  TriangleMesh halves = as_piece(whole);
  place_piece(halves, left_half([&] {
                TriangleMesh moved = whole;
                moved.vertices.col(0).array() -= 0.1;
                return moved;
              }()),
              0, false, {1, 0});
  TriangleMesh pressed = halves;
  pressed.sewing->seam_stiffness = 5;
  Positions x = whole.vertices;  // folded along the seam
  for (Eigen::Index i = 0; i < x.rows(); ++i) x(i, 2) = 0.3 * std::abs(x(i, 0) - 0.1);
  for (const std::string& energy : {std::string("hinge"), std::string("quadratic_bending"), bending[2]}) {
    INFO(energy);
    const auto plugin = make_plugin_from<Energy>(energy);
    const auto bind = [&](const Level& own) { return plugin->bind(own, {}); };
    const double plain = bind_with_seams(Level::of(0, halves), bind)->value(x),
                 stiff = bind_with_seams(Level::of(0, pressed), bind)->value(x);
    REQUIRE(plain > 0);
    CHECK(stiff == Approx(5 * plain).epsilon(1e-12));
  }
}

TEST_CASE("Loop would strain a flat piece that edge midpoints leave free of stress, so it is refused") {
  const TriangleMesh piece = as_piece(disc(0.2, 90));
  const Level coarse = Level::of(0, piece);
  const auto midpoint = make_plugin_from<Refiner>("midpoint"), loop = make_plugin_from<Refiner>("loop");
  const Level fine = Level::of(1, refined_rest(coarse, midpoint->weights(coarse)));
  const auto largest = [&](const Refiner& refiner) {
    return largest_stretch(fine, refiner.weights(coarse) * coarse.rest.vertices).maxCoeff();
  };
  CHECK(largest(*midpoint) == Approx(1).epsilon(1e-12));
  CHECK(largest(*loop) > 1.05);
  CHECK_THAT(refusal_of([&] { Hierarchy::of(piece, *loop, 2); }),
             Catch::Contains("write \"refiner: midpoint\""));
}
