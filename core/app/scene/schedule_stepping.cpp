#include <algorithm>
#include <map>
#include <stdexcept>

#include "core/app/scene/boundary_conditions.h"
#include "core/app/scene/load_schedule.h"
#include "core/app/scene/value_stepping.h"
#include "core/kernel/files/message_text.h"

namespace drape {

namespace {

/// The times of a key, and one between each two.
std::vector<double> times_with_between(const std::vector<double>& times) {
  constexpr double fraction = 0.38196601125;  // no round one, where two motions may happen to meet
  std::vector<double> all;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (i > 0) all.push_back(times[i - 1] + fraction * (times[i] - times[i - 1]));
    all.push_back(times[i]);
  }
  return all;
}

/// The faults of load_stepping_of.
void check_on_levels(const Experiment& e, const Scene& scene, const LoadSchedule& schedule,
                     ConfigErrors& errors) {
  const std::vector<Level>& levels = scene.hierarchy.levels;
  std::map<double, Conflicts> conflicts;         // of all pins and handles, at the times of their keys
  constexpr std::size_t most_bound = 1'000'000;  // energies × vertices; faults beyond show in the run
  std::size_t bound_before = 0;
  for (const ScheduleKey& key : e.parameters.schedule.keys) {
    if (key.is_of_contact()) continue;
    const bool of_vertices = key.section == "pins" || key.section == "handles";
    const Location& where = key.written.where;
    // Whether check(load, faults) finds no fault at any of these times; appends those of the first that has.
    const auto hold_at = [&](const std::vector<double>& times, const auto& check) {
      for (const double time : times) {
        ConfigErrors own;
        try {
          check(time, own);
        } catch (const std::runtime_error& problem) {
          own.push_back({where, problem.what()});
        }
        for (const ConfigError& error : own)
          errors.push_back({where, "key \"" + excerpt(key.parameter) + "\" at pseudo-time " +
                                       three_digits(time) + ": " + error.message});
        if (!own.empty()) return false;
      }
      return true;
    };
    // With the values that all other keys have at that time: two keys may move the bounds of one region.
    const auto load_at = [&](double time) { return schedule.at(schedule.keys().values_at(time)); };
    const bool bound = hold_at(key.times, [&](double time, ConfigErrors& own) {
      const LoadState load = *load_at(time);
      if (of_vertices) check_selections(e, *load.parameters, levels, own, &key);
      if (!own.empty() || key.section == "pins") return;
      for (const auto& first : scene.models) {  // throws for an energy that load stepping could not bind
        if (bound_before > most_bound) return;
        [[maybe_unused]] const LevelModel model(first->level(), load.parameters->material, load.energies, {},
                                                {}, first.get());
        bound_before += load.energies.size() * std::size_t(first->level().vertex_count());
      }
    });
    if (bound && of_vertices)
      hold_at(times_with_between(key.times), [&](double time, ConfigErrors& own) {
        const auto [found, is_new] = conflicts.try_emplace(time);
        if (is_new) found->second = conflicts_of(*load_at(time)->parameters, levels, scene.placed);
        report(found->second, e, levels, own, &key);
      });
  }
}

class ScheduleStepping final : public ValueStepping {
 public:
  /// Refers to the scene.
  ScheduleStepping(LoadSchedule schedule, const Scene& scene)
      : ValueStepping(scene, schedule.first()), schedule_(std::move(schedule)) {}

  int increment_count() const override { return schedule_.keys().steps; }
  bool equilibrates() const override { return schedule_.keys().equilibrate; }
  double time() const override { return schedule_.keys().time(increment()); }

 private:
  std::vector<double> values(int increment) const override { return schedule_.values(increment); }
  std::shared_ptr<const LoadState> load_at(std::vector<double> values,
                                           const LoadState& before) const override {
    return schedule_.at(std::move(values), before);
  }

  const LoadSchedule schedule_;
};

}  // namespace

std::unique_ptr<LoadStepping> load_stepping_of(const Experiment& e, const Scene& scene,
                                               ConfigErrors& errors) {
  LoadSchedule schedule(e, scene);
  const std::size_t before = errors.size();
  check_on_levels(e, scene, schedule, errors);
  if (errors.size() > before) return nullptr;
  return std::make_unique<ScheduleStepping>(std::move(schedule), scene);
}

}  // namespace drape
