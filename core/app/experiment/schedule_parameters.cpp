#include <algorithm>
#include <cmath>

#include "core/app/experiment/experiment_parameters.h"

namespace drape {

void ScheduleKey::declare(Declaration<ScheduleKey>& d) {
  d.add("parameter", &ScheduleKey::parameter,
        "path of the parameter, as for --set, in material, energies, contact, obstacles, friction, pins or "
        "handles; an index or a name selects an item of a list, as in energies.gravity.acceleration")
      .required();
  d.add("times", &ScheduleKey::times, "pseudo-times, ascending; the scene begins at 0")
      .between(0, 1e9)
      .required();
  d.add("values", &ScheduleKey::written, "one value per time, each a number or a list of numbers").required();
  d.add_choice("interpolation", &ScheduleKey::interpolation,
               {{"linear", KeyInterpolation::linear},
                {"log", KeyInterpolation::log},
                {"step", KeyInterpolation::step}},
               "interpolation between two times; constant before the first and after the last");
}

void ScheduleParameters::declare(Declaration<ScheduleParameters>& d) {
  d.add("duration", &ScheduleParameters::duration,
        "total pseudo-time, in the unit of `times`; 0 takes the last time of all keys")
      .between(0, 1e9);
  d.add("steps", &ScheduleParameters::steps, "number of equal load increments")
      .between(1, 1e6)
      .source("supplement, section 4");
  d.add("equilibrate", &ScheduleParameters::equilibrate,
        "solve for equilibrium after every increment; otherwise take one implicit step, and equilibrate only "
        "after the last increment");
  d.add_sections("keys", &ScheduleParameters::keys, "parameters that change");
}

std::vector<double> ScheduleKey::at(double time) const {
  const auto next = std::upper_bound(times.begin(), times.end(), time);
  if (next == times.begin()) return values.front();
  const auto i = static_cast<std::size_t>(next - times.begin()) - 1;
  if (next == times.end() || interpolation == KeyInterpolation::step) return values[i];
  const double part = (time - times[i]) / (times[i + 1] - times[i]);
  std::vector<double> value = values[i];
  for (std::size_t c = 0; c < value.size(); ++c)
    value[c] = interpolation == KeyInterpolation::log ? value[c] * std::pow(values[i + 1][c] / value[c], part)
                                                      : value[c] + part * (values[i + 1][c] - value[c]);
  return value;
}

double ScheduleParameters::time(int increment) const {
  double whole = duration;
  for (const ScheduleKey& key : keys)
    if (duration == 0 && !key.times.empty()) whole = std::max(whole, key.times.back());
  return whole * increment / steps;
}

std::vector<double> ScheduleParameters::values_at(double time) const {
  std::vector<double> all;
  for (const ScheduleKey& key : keys) {
    const std::vector<double> own = key.at(time);
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

}  // namespace drape
