#include "core/app/scene/boundary_conditions.h"

#include <catch2/catch.hpp>

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"
#include "tests/support/solve.h"

using namespace drape;

TEST_CASE("A vertex that a handle lists twice is pulled once") {
  const auto pulled = [](const std::string& vertices) {
    const Solved s = scene_from(R"(name: held
cloth: {shape: square, side: 0.4, columns: 5, rows: 5}
levels: 1
handles: [{region: vertices, vertices: )" +
                                vertices +
                                R"(, stiffness: 100}]
energies: [neo_hookean, hinge, gravity]
methods: {newton: {}}
)");
    return s.scene->model(0)->value(Positions(1.1 * s.scene->model(0)->level().rest.vertices));
  };
  CHECK(pulled("[24, 7, 24]") == pulled("[7, 24]"));
  CHECK(pulled("[7, 24]") > pulled("[7]"));
}

TEST_CASE("A pin and a handle without a transform hold where the start has them, on every level") {
  const Scratch folder;
  TriangleMesh raised = grid({0.4, 0.4}, 5, 5, Diagonals::one_way);
  raised.vertices.col(2).array() += 0.3;
  write_mesh(folder / "raised.ply", raised);
  for (const std::string& start :
       {std::string("translate: [0, 0, 0.3]"), "file: " + (folder / "raised.ply").string()}) {
    INFO(start);
    const Solved s = scene_from(R"(name: held
cloth: {shape: square, side: 0.4, columns: 5, rows: 5, triangulation: one_way}
levels: 2
start: {perturbation: 1e-3, )" + start +
                                R"(}
pins: [{region: ball, point: [0, 0, 0], radius: 0.11}]
handles: [{region: ball, point: [0.4, 0.4, 0], radius: 0.11}]
energies: [neo_hookean, hinge, gravity]
methods: {newton: {}}
)");
    for (int l = 0; l < 2; ++l) {
      INFO(l);
      const LevelModel& model = *s.scene->model(l);
      Positions x = model.level().rest.vertices;
      x.col(2).array() += 0.3;
      REQUIRE(model.dirichlet().size() > 2);
      for (const DirichletVertex& d : model.dirichlet()) CHECK(d.target == Eigen::Vector3d(x.row(d.vertex)));
      const auto of_handles = [&](const Positions& at) {
        for (const auto& [name, energy] : model.energy_parts(at))
          if (name == "handles") return energy;
        return -1.0;
      };
      const double far = of_handles(model.level().rest.vertices);
      CHECK(far > 0);
      CHECK(of_handles(x) <= 1e-28 * far);  // the target may be a rounding away from x
    }
  }
}
