// A flat sheet that is given as a flat piece where it lies has the energies and forces of the sheet, bit for
// bit, in every experiment of the project: what reads a rest shape reads both alike.

#include "core/numerics/mesh_files/io.h"
#include "tests/configs/runs.h"
#include "tests/support/sewn.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// Energy and forces of a level at its start, which noise has crumpled.
std::pair<double, Positions> forces_at_start(const Scene& scene, int level) {
  Positions x = scene.starts[level], gradient;
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] += 1e-4 * std::sin(static_cast<double>(37 * i + 1));
  const double energy = scene.model(level)->energy_gradient(x, gradient);
  return {energy, gradient};
}

}  // namespace

TEST_CASE("a flat piece has the energies of the sheet that it lies in, in every experiment") {
  int compared = 0;
  for (const char* name : {"configs", "configs/hard", "configs/tests"})
    for (const auto& entry : fs::directory_iterator(folders::source() / name)) {
      const fs::path& file = entry.path();
      if (file.extension() != ".yaml") continue;
      const std::string text = text_of(file);
      // Files' cloth need not be flat, obstacles of `make data` may be missing, and warp is a piece's y.
      bool other = false;
      for (const char* word :
           {"shape: file", "../data/", "woven", "grain", "fabric", "warp", "schedule", "follow"})
        other = other || text.find(word) != text.npos;
      if (other) continue;
      CAPTURE(file);
      Overrides small = {{"levels", "2"},
                         {"refiner", "midpoint"},
                         {"contact", "[]"},
                         {"obstacles", "[]"},
                         {"friction", "0"}};
      Overrides sewn = small;
      for (const auto& [key, value] :
           {std::pair("cloth.columns", "0"), {"cloth.rows", "0"}, {"cloth.vertices", "121"}})
        small.push_back({key, value});
      Solved sheet{experiment_in(file, small), nullptr, {}};
      sheet.scene = scene_of(sheet.experiment);
      const Scratch folder;
      write_mesh(folder / "piece.obj", as_piece(sheet.scene->hierarchy.levels[0].rest));
      sewn.push_back(
          {"cloth", "{shape: file, file: " + (folder / "piece.obj").string() + ", rest: uv, uv_unit: m}"});
      Solved piece{experiment_in(file, sewn), nullptr, {}};
      piece.scene = scene_of(piece.experiment);
      REQUIRE(piece.scene->hierarchy.levels[0].rest.sewing);
      for (int level = 0; level < 2; ++level) {
        const auto [energy, forces] = forces_at_start(*sheet.scene, level);
        const auto [other_energy, other_forces] = forces_at_start(*piece.scene, level);
        CHECK(energy == Approx(other_energy).epsilon(1e-12));
        CHECK((forces - other_forces).norm() < 1e-11 * forces.norm());
        CHECK((sheet.scene->model(level)->masses().array() == piece.scene->model(level)->masses().array())
                  .all());
      }
      ++compared;
    }
  CHECK(compared >= 10);
}
