#include "core/app/scene/load_state.h"

#include "core/app/scene/boundary_conditions.h"

namespace drape {

Positions own_of(const Hierarchy& hierarchy, const Positions& x, int fine, int coarse) {
  const Level &from = hierarchy.levels[fine], &to = hierarchy.levels[coarse];
  Positions own(to.vertex_count(), 3);
  for (int v = 0; v < to.vertex_count(); ++v) own.row(v) = x.row(from.own_vertex(to.cloth_vertex(v)));
  return own;
}

std::shared_ptr<const LevelModel> model_under(const LoadState& load, const Scene& scene, int level,
                                              const LevelModel& before) {
  const Hierarchy& hierarchy = scene.hierarchy;
  const Level &own = hierarchy.levels[level], &coarsest = hierarchy.levels[0];
  const auto with = [&](std::vector<DirichletVertex> dirichlet, const LevelModel& shared) {
    return std::make_shared<const LevelModel>(own, load.parameters->material, load.energies,
                                              std::move(dirichlet), load.contacts, &shared,
                                              load.rests.empty() ? nullptr : load.rests[level].get());
  };
  if (!load.pins_hold) return with({}, before);
  std::vector<DirichletVertex> dirichlet =
      dirichlet_vertices(*load.parameters, own, coarsest,
                         load.held_at ? own_of(hierarchy, *load.held_at, hierarchy.level_count() - 1, level)
                                      : scene.placed[level]);
  const FollowingVertices& following = scene.following[level];
  if (following.empty()) return with(std::move(dirichlet), before);
  const auto moved = with({}, before);  // where the obstacles are decides the targets
  move_targets(following, moved->obstacles(), dirichlet);
  return with(std::move(dirichlet), *moved);
}

}  // namespace drape
