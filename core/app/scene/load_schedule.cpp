#include "core/app/scene/load_schedule.h"

#include <algorithm>
#include <stdexcept>

#include "core/app/experiment/read_experiment.h"
#include "core/app/scene/boundary_conditions.h"
#include "core/kernel/plugin/registry.h"
#include "core/numerics/dressing/intermediate_rest.h"
#include "core/numerics/dressing/scaled_energy.h"

namespace drape {

namespace {

void throw_first(const ConfigErrors& errors) {
  if (!errors.empty()) throw std::runtime_error(errors[0].message);
}

template <class Interface>
void make_again(const PluginParameters& parameters, std::shared_ptr<Interface>& object) {
  ConfigErrors errors;
  object = std::static_pointer_cast<Interface>(make_plugin(
      parameters, [](const auto&, const auto&) { return Location(); }, errors, object.get()));
  throw_first(errors);
}

}  // namespace

std::shared_ptr<const Level> IntermediateRests::level(int level) const {
  const std::lock_guard lock(busy_);
  std::shared_ptr<const Level>& own = levels_[level];
  if (!own)
    own = std::make_shared<const Level>(
        with_intermediate_rest(scene_.hierarchy.levels[level], scene_.dressing->garments[level], placed_));
  return own;
}

Positions own_of(const Hierarchy& hierarchy, const Positions& x, int fine, int coarse) {
  const Level &from = hierarchy.levels[fine], &to = hierarchy.levels[coarse];
  Positions own(to.vertex_count(), 3);
  for (int v = 0; v < to.vertex_count(); ++v) own.row(v) = x.row(from.own_vertex(to.cloth_vertex(v)));
  return own;
}

LoadSchedule::LoadSchedule(const Experiment& e, const Scene& scene)
    : scene_(scene), keys_([&] {
        ScheduleParameters keys = e.parameters.schedule;
        if (e.parameters.dress.is_asked()) keys.keys[0].values[0][0] = scene.dressing->contraction;
        return keys;
      }()) {
  std::size_t first = 0;
  for (const ScheduleKey& key : e.parameters.schedule.keys) {
    for (const KeyTarget& target : key.targets)
      change_of(e, target).numbers.emplace_back(target.numbers, first);
    first += key.values[0].size();
  }
  const auto parameters = std::make_shared<ExperimentParameters>(e.parameters);
  parameters->schedule = {};  // of which each load would have a copy
  // The scene's own models have a schedule's first load, but are those of a garment that is worn.
  std::vector<double> values =
      e.parameters.dress.is_asked() ? keys_.values_at(keys_.time(keys_.steps)) : keys_.values_at(0);
  first_ = std::make_shared<const LoadState>(
      LoadState{std::move(values), parameters, scene.energies, e.contacts, nullptr, nullptr});
}

LoadSchedule::Change& LoadSchedule::change_of(const Experiment& e, const KeyTarget& target) {
  for (Change& change : changes_)
    if (change.part == target.part && change.item == target.item) return change;
  PluginParameters first = parameters_of(e, target.part, target.item);
  if (!first.entry) first.values.reset();
  return changes_.emplace_back(Change{target.part, target.item, std::move(first), {}});
}

std::shared_ptr<const LoadState> LoadSchedule::at(std::vector<double> values, const LoadState& before) const {
  auto load = std::make_shared<LoadState>(before);
  std::shared_ptr<ExperimentParameters> parameters;  // once one of the experiment's own differs
  bool new_handles = false;
  for (const Change& change : changes_) {
    const bool differs = std::any_of(change.numbers.begin(), change.numbers.end(), [&](const auto& one) {
      const auto first = static_cast<std::ptrdiff_t>(one.second);
      return !std::equal(values.begin() + first,
                         values.begin() + first + static_cast<std::ptrdiff_t>(one.first.count()),
                         before.values.begin() + first);
    });
    if (!differs) continue;
    const RegistryEntry* entry = change.first.entry;
    PluginParameters own{entry, entry ? entry->schema.copy(change.first.values.get()) : nullptr};
    if (!entry && !parameters) parameters = std::make_shared<ExperimentParameters>(*before.parameters);
    ConfigErrors errors;
    for (const auto& [numbers, first] : change.numbers)
      numbers.set(entry ? own.values.get() : parameters.get(), &values[first], errors);
    throw_first(errors);
    new_handles = new_handles || change.part == LoadPart::handles;
    if (change.part == LoadPart::energies) make_again(own, load->energies[change.item].energy);
    if (change.part == LoadPart::contact) make_again(own, load->contacts[change.item]);
  }
  if (parameters) load->parameters = parameters;
  if (parameters && parameters->dress.is_asked()) dress(*load, before);
  if (new_handles)
    load->energies.back().energy = handles_energy(*parameters, scene_.hierarchy.levels[0], scene_.placed);
  load->values = std::move(values);
  return load;
}

Positions LoadSchedule::placed(const LoadState& load, int level) const {
  if (!load.sewn) return scene_.placed[level];
  return own_of(scene_.hierarchy, *load.sewn, scene_.hierarchy.level_count() - 1, level);
}

/// Gives a load the loads and the rest shapes of its phase.
void LoadSchedule::dress(LoadState& load, const LoadState& before) const {
  const DressParameters &own = load.parameters->dress, &old = before.parameters->dress;
  if (own.placed != old.placed)
    load.rests = own.placed > 0 ? std::make_shared<const IntermediateRests>(scene_, own.placed) : nullptr;
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
                                              load.rests ? load.rests->level(level) : nullptr);
  };
  if (load.parameters->dress.loads == 0) return with({}, before);
  std::vector<DirichletVertex> dirichlet =
      dirichlet_vertices(*load.parameters, own, coarsest, placed(load, level));
  const FollowingVertices& following = scene_.following[level];
  if (following.empty()) return with(std::move(dirichlet), before);
  const auto moved = with({}, before);  // where the obstacles are decides the targets
  move_targets(following, moved->contacts(), dirichlet);
  return with(std::move(dirichlet), *moved);
}

}  // namespace drape
