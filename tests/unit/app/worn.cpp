// Garments whose openings no part of the body passes through: what they are called, and how a level ends.

#include "core/app/dressing/worn.h"

#include "core/app/dressing/verdict.h"
#include "core/app/experiment/sewn_cloth.h"
#include "core/numerics/hierarchy/midpoint.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/solve.h"
#include "tests/support/tube_dress.h"

using namespace drape;

namespace {

constexpr const char* material =
    "material: {density: 300, thickness: 5e-4, membrane_modulus: 4e5, bending_modulus: 1e5}\n"
    "energies: [neo_hookean, hinge, gravity]\n";

TubeDress small_tube() { return {.columns = 8, .rows = 5, .facets = 24}; }

/// A level's result that has come to rest with the garment beside where it starts.
LevelResult at_rest(const Scene& scene, double beside) {
  LevelResult result;
  result.level = scene.finest();
  result.x = scene.starts.back();
  result.x.col(0).array() += beside;
  return result;
}

}  // namespace

TEST_CASE("A garment that came to rest beside its body is told, and an error with dress.worn") {
  const Scratch folder;
  small_tube().write(folder, material);
  // As it is placed it is far longer along its seams than at rest.
  const std::string tight = "the garment is tight: a tenth of piece front is stretched by more than 339 %",
                    fault =
                        "; the garment is not worn: no part of the body passes through the opening of "
                        "front and back at (1, ";
  for (const bool worn : {false, true}) {
    INFO(worn);
    const Experiment experiment = experiment_in(folder / "e.yaml", {{"dress.worn", worn ? "true" : "false"}});
    const auto scene = scene_of(experiment);
    const LevelResult good = with_verdict(experiment, *scene, at_rest(*scene, 0));
    CHECK(good.outcome == Outcome::converged);
    CHECK(good.message == tight);
    const LevelResult beside = with_verdict(experiment, *scene, at_rest(*scene, 1));
    CHECK(beside.outcome == (worn ? Outcome::infeasible : Outcome::converged));
    CHECK_THAT(beside.message, Catch::StartsWith(tight + fault) && Catch::Contains("; nor through that of "));
    LevelResult moving = at_rest(*scene, 1);
    moving.outcome = Outcome::stalled;
    CHECK(with_verdict(experiment, *scene, moving).message.empty());
  }
}

TEST_CASE("A garment that hangs on a smaller body by one opening is worn") {
  const Scratch folder;
  small_tube().write(folder, material);
  const Experiment experiment = experiment_in(folder / "e.yaml");
  const auto scene = scene_of(experiment);
  const Level& level = scene->hierarchy.levels[0];
  Positions x = level.rest.vertices;  // a wide tube around the origin, closed like a funnel below
  for (auto v : x.rowwise()) v.head(2) *= v[2] < 0 ? 0.02 : 1;
  TriangleMesh body = dressed_body(experiment, *scene->models[0]);
  body.vertices.rowwise() -= bounding_box(body.vertices).center().transpose();
  const auto text = [&](double scale, const Eigen::RowVector3d& at) {
    return not_worn_text(experiment.parameters.cloth, level, x,
                         {(scale * body.vertices).rowwise() + at, body.triangles});
  };
  CHECK_THAT(text(1, {0, 0, 0.3}), Catch::StartsWith("no part of the body passes through the opening of "));
  CHECK(text(0.3, {0, 0, 0.1}).empty());
  CHECK_THAT(text(0.3, {0, 0, 0.3}), Catch::Contains("; nor through that of "));
}

TEST_CASE("An opening is called by its pieces and their edges in the pattern, on each level") {
  ClothParameters cloth;
  cloth.shape = "pattern";
  cloth.file = (folders::source() / "configs/garments/tshirt.yaml").string();
  cloth.edge_length = 0.06;
  ConfigErrors errors;
  const Level coarse = Level::of(0, cloth_of_pattern(cloth, errors).value()),
              fine = Level::of(1, refined_rest(coarse, midpoint_weights(coarse)));
  for (const Level* level : {&coarse, &fine}) {
    TriangleMesh elsewhere = unit_sphere(1);
    elsewhere.vertices.col(0).array() += 100;
    const std::string text = not_worn_text(cloth, *level, level->rest.vertices, elsewhere);
    for (const char* opening :
         {"front, by its edge hem, and back, by its edge hem",
          "front, by its edge neck, and back, by its edge neck",
          "sleeve_left_front, by its edge cuff, and sleeve_left_back, by its edge cuff",
          "sleeve_right_front, by its edge cuff, and sleeve_right_back, by its edge cuff"})
      CHECK_THAT(text, Catch::Contains(opening));
  }
}
