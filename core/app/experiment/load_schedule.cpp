#include "core/app/experiment/load_schedule.h"

#include <algorithm>
#include <stdexcept>

#include "core/app/experiment/boundary_conditions.h"
#include "core/app/experiment/following_pins.h"
#include "core/app/experiment/schedule_keys.h"

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

LoadSchedule::LoadSchedule(const Experiment& e, const Scene& scene)
    : hierarchy_(scene.hierarchy), placed_(scene.placed), following_(scene.following) {
  std::size_t first = 0;
  for (const ScheduleKey& key : e.parameters.schedule.keys) {
    for (const KeyTarget& target : key.targets)
      change_of(e, target).numbers.emplace_back(target.numbers, first);
    first += key.values[0].size();
  }
  auto parameters = std::make_shared<const ExperimentParameters>(e.parameters);
  std::vector<double> values;
  for (const ScheduleKey& key : e.parameters.schedule.keys)
    values.insert(values.end(), key.values[0].begin(), key.values[0].end());
  first_ = std::make_shared<const LoadState>(
      LoadState{std::move(values), std::move(parameters), scene.energies, e.contacts});
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
  if (new_handles) load->energies.back().energy = handles_energy(*parameters, hierarchy_.levels[0], placed_);
  load->values = std::move(values);
  return load;
}

std::shared_ptr<const LevelModel> LoadSchedule::model(const LoadState& load, int level,
                                                      const LevelModel& before) const {
  const Level &own = hierarchy_.levels[level], &coarsest = hierarchy_.levels[0];
  const auto with = [&](std::vector<DirichletVertex> dirichlet, const LevelModel& shared) {
    return std::make_shared<const LevelModel>(own, load.parameters->material, load.energies,
                                              std::move(dirichlet), load.contacts, &shared);
  };
  std::vector<DirichletVertex> dirichlet =
      dirichlet_vertices(*load.parameters, own, coarsest, placed_[level]);
  if (following_[level].empty()) return with(std::move(dirichlet), before);
  const auto moved = with({}, before);  // where the obstacles are decides the targets
  move_targets(following_[level], moved->contacts(), dirichlet);
  return with(std::move(dirichlet), *moved);
}

}  // namespace drape
