#include <iostream>
#include <stdexcept>

#include "core/kernel/interfaces/solver.h"
#include "core/kernel/plugin/loader.h"
#include "core/kernel/plugin/make.h"
#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/model/level_model.h"
#include "core/numerics/patterns/generate.h"

using namespace drape;

/// A plugin by its name, with its default parameters.
template <class Interface>
std::shared_ptr<Interface> make(const Registry& plugins, const char* name) {
  ConfigErrors errors;
  auto made = make_from<Interface>(plugins, ConfigNode::of(name), errors);
  if (!made) throw std::runtime_error(errors.front().message);
  return made;
}

int main() try {
  Registry plugins;
  load_plugins(plugins, plugin_directories());
  const auto refiner = make<Refiner>(plugins, "loop");
  const auto solver = make<Solver>(plugins, "pcs");
  std::vector<NamedEnergy> energies;
  for (const char* name : {"neo_hookean", "hinge", "gravity"})
    energies.push_back({name, make<Energy>(plugins, name)});

  const Hierarchy hierarchy = Hierarchy::of(grid({1, 1}, 21, 21, Diagonals::criss_cross), *refiner, 3);
  Problem problem{hierarchy, {}, {}, nullptr};
  for (const Level& level : hierarchy.levels) {
    std::vector<DirichletVertex> held;  // two corners, which keep their numbers on finer levels
    for (const int corner : {0, 20}) held.push_back({corner, level.rest.vertices.row(corner)});
    problem.models.push_back(std::make_shared<LevelModel>(level, Material(), energies, held));
    problem.starts.push_back(level.rest.vertices);
  }

  Observer nobody;
  for (const LevelResult& result : solver->solve(problem, nobody)) {
    std::cout << "level " << result.level << ": " << to_string(result.outcome) << " after "
              << result.iterations << " iterations, lowest point " << result.x.col(2).minCoeff() << " m\n";
    write_mesh("level_" + std::to_string(result.level) + ".obj",
               {result.x, hierarchy.levels[result.level].rest.triangles});
  }
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
