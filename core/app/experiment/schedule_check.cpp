#include <stdexcept>

#include "core/app/experiment/boundary_conditions.h"
#include "core/app/experiment/load_schedule.h"
#include "core/app/experiment/shared_vertices.h"
#include "core/kernel/files/message_text.h"

namespace drape {

namespace {

/// Binds the energies under a load on every level, as load stepping does. Throws std::runtime_error with the
/// fault of the first that cannot be bound or has other stencils than under the first load.
void bind_energies(const LoadState& load, const Scene& scene) {
  for (const auto& first : scene.models)
    LevelModel(first->level(), load.parameters->material, load.energies, {}, {}, first.get());
}

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

}  // namespace

void check_schedule_on_levels(const Experiment& e, const Scene& scene, const LoadSchedule& schedule,
                              ConfigErrors& errors) {
  const std::vector<ScheduleKey>& keys = e.parameters.schedule.keys;
  const std::vector<Level>& levels = scene.hierarchy.levels;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const LoadPart part = keys[k].targets[0].part;
    const std::size_t item = keys[k].targets[0].item;
    if (part == LoadPart::contact) continue;
    const bool of_vertices = part == LoadPart::pins || part == LoadPart::handles;
    const Location where = e.source.find("schedule")->find("keys")->items[k].find("values")->where;
    // Whether check(load, faults) finds no fault at any of these times; appends those of the first that has.
    const auto hold_at = [&](const std::vector<double>& times, const auto& check) {
      for (const double time : times) {
        ConfigErrors own;
        try {
          // With the values that all other keys have at that time: two keys may move the bounds of one
          // region.
          check(*schedule.at(schedule.keys().values_at(time)), own);
        } catch (const std::runtime_error& problem) {
          own.push_back({where, problem.what()});
        }
        for (const ConfigError& error : own)
          errors.push_back({where, "key \"" + excerpt(keys[k].parameter) + "\" at pseudo-time " +
                                       three_digits(time) + ": " + error.message});
        if (!own.empty()) return false;
      }
      return true;
    };
    const bool bound = hold_at(keys[k].times, [&](const LoadState& load, ConfigErrors& own) {
      if (of_vertices) check_selection(*load.parameters, part, item, where, levels, own);
      if (own.empty() && part != LoadPart::pins) bind_energies(load, scene);
    });
    if (bound && of_vertices)
      hold_at(times_with_between(keys[k].times), [&](const LoadState& load, ConfigErrors& own) {
        check_shared_vertices(*load.parameters, part, item, where, levels, scene.placed, own);
      });
  }
}

}  // namespace drape
