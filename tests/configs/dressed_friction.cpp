// Garments that friction holds while they are put on.

#include <Eigen/Eigenvalues>
#include <limits>

#include "core/app/dressing/pin_support.h"
#include "core/numerics/model/derivative_check.h"
#include "tests/configs/killed_dressings.h"
#include "tests/support/evaluate.h"
#include "tests/support/tube_dress.h"

using namespace drape;

namespace {

constexpr const char* material =
    "material: {density: 300, thickness: 4e-4, membrane_modulus: 5e5, bending_modulus: 1e5}\n"
    "energies: [neo_hookean, hinge, gravity]\n";

/// Writes an elastic band of .76 m around a cone that becomes wider upwards, with a tangent of .186: it is
/// placed in the middle, and slides down the cone where friction does not hold it.
void write_band(const Scratch& folder, double edge_length) {
  TubeDress{.radius = 0.126, .body_height = 0.5, .widening = 0.186, .facets = 64}.write(folder, material);
  folder.write("band.yaml", R"(properties: {units_in_meter: 100, up: y}
pattern:
  panels:
    front: {translation: [0, -6, 20], vertices: {a: [-19, 0], b: [19, 0], c: [19, 12], d: [-19, 12]}, edges: &e {hem: [a, b], left: [b, c], top: [c, d], right: [d, a]}}
    back: {translation: [0, -6, -20], rotation: [0, 180, 0], vertices: {a: [-19, 0], b: [19, 0], c: [19, 12], d: [-19, 12]}, edges: *e}
  stitches: {l: [front.left, back.right], r: [front.right, back.left]}
)");
  const std::string text = text_of(folder / "e.yaml"),
                    mesh = "{shape: file, file: tube.obj, rest: uv, uv_unit: m}";
  folder.write(
      "e.yaml",
      replaced(text, mesh,
               "{shape: pattern, file: band.yaml, edge_length: " + std::to_string(edge_length) + "}"));
}

/// A body with friction of its own, where the cloth has none.
Overrides with_own_friction(const Scratch& folder, const std::string& friction) {
  return {{"friction", "0"},
          {"dress", "{obstacle: body}"},
          {"obstacles",
           "[{name: body, mesh: " + (folder / "body.obj").string() + ", friction: " + friction + "}]"}};
}

/// The mean height of the band with these changes [m]; 0 is where it was placed.
double height_of_band(const Scratch& folder, const Overrides& overrides) {
  const Solved s = solved(experiment_in(folder / "e.yaml", overrides));
  INFO(s.levels[0].message);
  for (const auto& contact : s.model().contacts()) CHECK(contact->intersections(s.x()).empty());
  return s.x().col(2).mean();
}

/// The highest point of the hem of a box's cover that is 3 % too small, put on with these changes [m];
/// infinite if it drifts away.
double hem_of_cover(const Overrides& overrides) {
  const Scratch folder;
  folder.write(
      "box.obj",
      "v -0.2 -0.15 0\nv 0.2 -0.15 0\nv 0.2 0.15 0\nv -0.2 0.15 0\nv -0.2 -0.15 0.2\nv 0.2 -0.15 0.2\n"
      "v 0.2 0.15 0.2\nv -0.2 0.15 0.2\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const auto panel = [](const std::string& name, const std::string& place, double half, double height) {
    const std::string x = std::to_string(half), y = std::to_string(height);
    return "    " + name + ": {" + place + ", vertices: {a: [-" + x + ", 0], b: [" + x + ", 0], c: [" + x +
           ", " + y + "], d: [-" + x + ", " + y +
           "]}, edges: {bottom: [a, b], right: [b, c], top: [c, d], left: [d, a]}}\n";
  };
  folder.write(
      "cover.yaml",
      "properties: {units_in_meter: 100, up: y}\npattern:\n  panels:\n" +
          panel("front", "translation: [0, 3.6, 18]", 19.4, 19.4) +
          panel("back", "translation: [0, 3.6, -18], rotation: [0, 180, 0]", 19.4, 19.4) +
          panel("right", "translation: [23, 3.6, 0], rotation: [0, 90, 0]", 14.55, 19.4) +
          panel("left", "translation: [-23, 3.6, 0], rotation: [0, -90, 0]", 14.55, 19.4) +
          panel("top", "translation: [0, 23, 14.55], rotation: [-90, 0, 0]", 19.4, 29.1) +
          "  stitches: {fr: [front.right, right.left], rb: [right.right, back.left], bl: [back.right, "
          "left.left], lf: [left.right, front.left], tf: [front.top, top.bottom], tr: [right.top, "
          "top.right], "
          "tb: [back.top, top.top], tl: [left.top, top.left]}\n");
  folder.write(
      "e.yaml",
      "name: cover\ncloth: {shape: pattern, file: cover.yaml, edge_length: 0.04}\nlevels: 1\nmaterial: "
      "{density: 500, thickness: 5e-4, membrane_modulus: 2e6, bending_modulus: 2e5, poisson_ratio: 0}\n"
      "energies: [neo_hookean, hinge, gravity]\ncontact: {type: ipc, dhat: 0.001}\nfriction: 0.3\ndress: "
      "{body: box.obj}\nmethods: {pcs: {}}\nmetrics: []\n");
  const Solved s = solved(experiment_in(folder / "e.yaml", overrides));
  INFO(s.levels[0].message);
  if (s.levels[0].message.find("it has drifted by") != std::string::npos)
    return std::numeric_limits<double>::infinity();
  CHECK(s.levels[0].outcome == Outcome::converged);
  double highest = 0;
  for (int v = 0; v < s.level().vertex_count(); ++v)
    if (s.level().topology.on_border[v]) highest = std::max(highest, s.x()(v, 2));
  return highest;
}

}  // namespace

TEST_CASE("A band that friction holds on a cone stays where it is put on, and one without falls") {
  const Scratch folder;
  write_band(folder, 0.013);
  CHECK(std::abs(height_of_band(folder, {{"friction", "0.4"}})) < 0.01);
  CHECK(std::abs(height_of_band(folder, with_own_friction(folder, "0.4"))) < 0.01);
  CHECK(height_of_band(folder, {{"friction", "0"}}) < -0.05);
}

TEST_CASE("Pins keep a garment up until it is sewn, when they hold it") {
  const Scratch folder;
  write_band(folder, 0.03);
  const auto height = [&](const std::string& pins) {
    return height_of_band(folder, {{"friction", "0"}, {"pins", pins}, {"methods.pcs", "{}"}});
  };
  CHECK(height("[{region: piece, piece: front}]") > -0.04);  // .1 while nothing supports it
  CHECK(height("[]") < -0.05);
}

TEST_CASE("The force that supports pins is the derivative of its energy, and acts far below alone") {
  const Scratch folder;
  write_band(folder, 0.05);
  const Experiment e = experiment_in(folder / "e.yaml", {{"pins", "[{region: piece, piece: front}]"}});
  const auto scene = scene_of(e);
  const Positions placed = scene->starts[0];
  DressingStart start;
  start.placed = placed;
  const DressingSetup setup{e, *scene, std::make_shared<const DressingStart>(std::move(start))};
  const Level& level = scene->hierarchy.levels[0];
  const auto support = pin_support(setup)->bind(level, e.parameters.material);
  CHECK(support->value(placed.rowwise() + Eigen::RowVector3d(0.3, 0, 0.1)) == 0);
  Positions x = placed;
  x.col(2).array() -= 0.03;
  CHECK(support->value(x) == Approx(5e5 * 4e-4 * 0.01 * 0.01 / 2));
  x += 0.005 * Positions::Random(x.rows(), 3);
  CHECK(check_derivatives(*support, x, 1e-4).gradient.error < 1e-8);
  // Its Hessian is exact for a translation, and not smaller for any other motion.
  const Eigen::MatrixXd hessian = dense(hessian_of(*support, x, Projection::none)),
                        difference = hessian - hessian_by_differences(*support, x, 1e-4);
  CHECK((difference * flat(Positions::Ones(x.rows(), 3))).norm() < 1e-6 * hessian.norm());
  CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(difference).eigenvalues()[0] > -1e-6 * hessian.norm());
}

TEST_CASE("An obstacle's own friction does not act while a garment that rises is sewn") {
  const Scratch folder;
  TubeDress{.columns = 8, .rows = 5, .facets = 24}.write(folder, material);
  const auto end = [&](const Overrides& overrides) {
    return solved(experiment_in(folder / "e.yaml", overrides)).x();
  };
  const Positions of_experiment = end({});
  CHECK((end(with_own_friction(folder, "0.3")) - of_experiment).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("A dressing that is killed while its garment is sewn again resumes to the same bits") {
  const Scratch folder;
  write_band(folder, 0.03);
  check_killed_in(folder, {"sewing", "sewing again", "weight"});
}

TEST_CASE("A cover that springs off stays on with friction from the beginning") {
  CHECK(hem_of_cover({}) > 0.1);
  CHECK(hem_of_cover({{"dress.friction", "0.3"}}) < 0.07);
}
