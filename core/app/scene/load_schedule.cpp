#include "core/app/scene/load_schedule.h"

#include <algorithm>
#include <stdexcept>

#include "core/app/scene/boundary_conditions.h"
#include "core/numerics/dressing/garment_rest.h"
#include "core/numerics/elements/scaled_energy.h"

namespace drape {

Positions own_of(const Hierarchy& hierarchy, const Positions& x, int fine, int coarse) {
  const Level &from = hierarchy.levels[fine], &to = hierarchy.levels[coarse];
  Positions own(to.vertex_count(), 3);
  for (int v = 0; v < to.vertex_count(); ++v) own.row(v) = x.row(from.own_vertex(to.cloth_vertex(v)));
  return own;
}

LoadSchedule::LoadSchedule(const Experiment& e, const Scene& scene)
    : experiment_(e), scene_(scene), keys_([&] {
        ScheduleParameters keys = e.parameters.schedule;
        if (e.parameters.dress.is_asked()) keys.keys[0].values[0][0] = scene.dressing->contraction;
        return keys;
      }()) {
  const auto parameters = std::make_shared<ExperimentParameters>(e.parameters);
  parameters->schedule = {};  // of which each load would have a copy
  // The scene's own models have a schedule's first load, but are those of a garment that is worn.
  std::vector<double> values =
      e.parameters.dress.is_asked() ? keys_.values_at(keys_.time(keys_.steps)) : keys_.values_at(0);
  first_ = std::make_shared<const LoadState>(
      LoadState{{std::move(values), parameters, scene.energies, e.contacts}, {}, nullptr});
}

std::shared_ptr<const LoadState> LoadSchedule::at(std::vector<double> values, const LoadState& before) const {
  auto load = std::make_shared<LoadState>(before);
  ConfigErrors errors;
  const auto changed = set_values(experiment_, std::move(values), *load, errors);
  if (!errors.empty()) throw std::runtime_error(errors[0].message);
  const ExperimentParameters& own = *load->parameters;
  if (load->parameters != before.parameters && own.dress.is_asked()) dress(*load, before);
  if (std::ranges::find(changed, "handles", &ScheduleKey::section) != changed.end())
    load->energies.back().energy = handles_energy(own, scene_.hierarchy.levels[0], scene_.placed);
  return load;
}

Positions LoadSchedule::placed(const LoadState& load, int level) const {
  if (!load.sewn) return scene_.placed[level];
  return own_of(scene_.hierarchy, *load.sewn, scene_.hierarchy.level_count() - 1, level);
}

/// Gives a load the loads and the rest shapes of its phase.
void LoadSchedule::dress(LoadState& load, const LoadState& before) const {
  const DressParameters &own = load.parameters->dress, &old = before.parameters->dress;
  if (own.placed != old.placed) {
    load.rests.clear();
    for (int level = 0; own.placed > 0 && level < scene_.hierarchy.level_count(); ++level)
      load.rests.emplace_back([&scene = scene_, level, weight = own.placed] {
        return with_intermediate_rest(scene.hierarchy.levels[level], scene.dressing->garments[level], weight);
      });
  }
  if (own.loads == old.loads) return;
  for (std::size_t k = 0; k < load.energies.size(); ++k) {
    const std::shared_ptr<const Energy>& whole = scene_.energies[k].energy;
    if (whole->role() == EnergyRole::external) load.energies[k].energy = scaled(whole, own.loads);
  }
}

std::shared_ptr<const LevelModel> LoadSchedule::model(const LoadState& load, int level,
                                                      const LevelModel& before) const {
  const Level &own = scene_.hierarchy.levels[level], &coarsest = scene_.hierarchy.levels[0];
  const auto with = [&](std::vector<DirichletVertex> dirichlet, const LevelModel& shared) {
    return std::make_shared<const LevelModel>(own, load.parameters->material, load.energies,
                                              std::move(dirichlet), load.contacts, &shared,
                                              load.rests.empty() ? nullptr : load.rests[level].get());
  };
  if (load.parameters->dress.loads == 0) return with({}, before);
  std::vector<DirichletVertex> dirichlet =
      dirichlet_vertices(*load.parameters, own, coarsest, placed(load, level));
  const FollowingVertices& following = scene_.following[level];
  if (following.empty()) return with(std::move(dirichlet), before);
  const auto moved = with({}, before);  // where the obstacles are decides the targets
  move_targets(following, moved->obstacles(), dirichlet);
  return with(std::move(dirichlet), *moved);
}

}  // namespace drape
