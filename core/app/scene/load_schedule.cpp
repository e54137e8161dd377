#include "core/app/scene/load_schedule.h"

#include <algorithm>
#include <stdexcept>

#include "core/app/scene/boundary_conditions.h"

namespace drape {

LoadSchedule::LoadSchedule(const Experiment& e, const Scene& scene) : experiment_(e), scene_(scene) {
  const auto parameters = std::make_shared<ExperimentParameters>(e.parameters);
  parameters->schedule = {};  // of which each load would have a copy
  first_ = std::make_shared<const LoadState>(
      LoadState{{keys().values_at(0), parameters, scene.energies, e.contacts}, {}, true, nullptr});
}

std::shared_ptr<const LoadState> LoadSchedule::at(std::vector<double> values, const LoadState& before) const {
  auto load = std::make_shared<LoadState>(before);
  ConfigErrors errors;
  const std::vector<LoadValue> own = load_values(keys().keys, values, before.values);
  set_values(experiment_, own, *load, errors);
  if (!errors.empty()) throw std::runtime_error(errors[0].message);
  if (std::ranges::any_of(own, [](const LoadValue& v) { return v.changes && v.section == "handles"; }))
    load->energies.back().energy =
        handles_energy(*load->parameters, scene_.hierarchy.levels[0], scene_.placed);
  load->values = std::move(values);
  return load;
}

}  // namespace drape
