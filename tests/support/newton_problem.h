#pragma once

#include "core/numerics/patterns/generate.h"
#include "core/numerics/step/iterate.h"

/// An iterate at the rest shape of a sheet of 4×4 vertices, evaluated, for tests of the Newton solver's
/// parts.
struct NewtonProblem {
  drape::Level level = sheet();
  drape::LevelModel model;
  drape::PlainObjective objective;
  drape::LevelResult result;
  drape::Iterate iterate;

  explicit NewtonProblem(const std::vector<std::shared_ptr<drape::Energy>>& energies,
                         std::vector<drape::DirichletVertex> dirichlet = {},
                         const std::vector<std::shared_ptr<drape::ContactModel>>& contacts = {})
      : model(level, drape::Material(), named(energies), std::move(dirichlet), contacts),
        objective(model),
        iterate(objective, result) {
    move_to(level.rest.vertices);
  }

  static drape::Positions rest() { return sheet().rest.vertices; }

  void move_to(const drape::Positions& x) {
    iterate.move_to(x);
    iterate.set_constraints(model.fixed(), nullptr);
    iterate.evaluate();
    iterate.update_residual();
  }

 private:
  static drape::Level sheet() {
    return drape::Level::of(0, drape::grid({1, 1}, 4, 4, drape::Diagonals::one_way));
  }
  static std::vector<drape::NamedEnergy> named(const std::vector<std::shared_ptr<drape::Energy>>& energies) {
    std::vector<drape::NamedEnergy> result;
    for (const auto& energy : energies) result.push_back({"energy", energy});
    return result;
  }
};
