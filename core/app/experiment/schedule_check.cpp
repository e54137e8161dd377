#include "core/app/experiment/schedule_check.h"

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

/// Appends an error for each pin or handle, of those that the path's key names, that comes into conflict with
/// the one that the key moves.
void check_shared_over_time(const std::vector<std::string>& path, const std::vector<double>& times,
                            const LoadSchedule& schedule, const Scene& scene, const Location& where,
                            const std::string& name, ConfigErrors& errors) {
  for (const double time : times_with_between(times)) {
    ConfigErrors own;
    try {
      check_shared_vertices(*schedule.at(schedule.values_at(time))->parameters, path[0], std::stoul(path[1]),
                            where, scene.hierarchy.levels, scene.placed, own);
    } catch (const std::runtime_error& problem) {
      own.push_back({where, problem.what()});
    }
    for (const ConfigError& error : own)
      errors.push_back({where, name + " at pseudo-time " + three_digits(time) + ": " + error.message});
    if (!own.empty()) return;
  }
}

}  // namespace

void check_schedule_on_levels(const Experiment& e, const Scene& scene, ConfigErrors& errors) {
  const std::vector<KeyParameters>& keys = e.parameters.schedule.keys;
  if (keys.empty()) return;
  const LoadSchedule schedule(e, scene);
  const std::vector<Level>& levels = scene.hierarchy.levels;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const std::vector<std::string> path = indexed_path(e.resolved, keys[k].parameter);
    const bool of_pin = path[0] == "pins", of_handle = path[0] == "handles";
    if (!of_pin && !of_handle && path[0] != "energies" && path[0] != "material") continue;
    const Location where = e.source.find("schedule")->find("keys")->items[k].find("values")->where;
    const std::string name = "key \"" + excerpt(keys[k].parameter) + "\"";
    ConfigErrors own;
    for (const double time : keys[k].times) {
      try {
        // With the values that all other keys have at that time: two keys may move the bounds of one region.
        const auto load = schedule.at(schedule.values_at(time));
        if (of_pin) check_pin(*load->parameters, std::stoul(path[1]), where, levels, own);
        if (of_handle) check_handle(*load->parameters, std::stoul(path[1]), where, levels, own);
        if (own.empty() && !of_pin) bind_energies(*load, scene);
      } catch (const std::runtime_error& problem) {
        own.push_back({where, problem.what()});
      }
      for (const ConfigError& error : own)
        errors.push_back({where, name + " at pseudo-time " + three_digits(time) + ": " + error.message});
      if (!own.empty()) break;
    }
    if (own.empty() && (of_pin || of_handle))
      check_shared_over_time(path, keys[k].times, schedule, scene, where, name, errors);
  }
}

}  // namespace drape
