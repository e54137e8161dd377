#include "core/app/dressing/dressing_loads.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/app/dressing/load_forces.h"
#include "core/app/experiment/experiment_path.h"

namespace drape {

namespace {

/// Parameters of an experiment whose values differ from load to load.
std::vector<LoadValue> without_values(const Experiment& e, const std::vector<std::string>& paths) {
  std::vector<LoadValue> all;
  for (const std::string& path : paths) {
    const std::vector<std::string> words = words_of_path(e.resolved, path);
    const auto item = words.size() > 1 ? e.resolved.find(words[0])->index_of(words[1]) : std::nullopt;
    all.push_back({path, words[0], item.value_or(0), {}, false});
  }
  return all;
}

/// Appends these parameters with the first of the values, where a load before had the others.
void append(std::vector<LoadValue> parameters, std::span<const double> values, std::span<const double> before,
            std::vector<LoadValue>& all) {
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    parameters[k].value = ConfigNode::of(values[k]);
    parameters[k].changes = values[k] != before[k];
    all.push_back(std::move(parameters[k]));
  }
}

}  // namespace

DressingLoads::DressingLoads(const Experiment& experiment, const Scene& scene, DressingStart start)
    : experiment_(experiment),
      frictions_(experiment_),
      friction_parameters_(without_values(experiment_, frictions_.parameters())) {
  const DressingSetup setup{experiment_, scene, std::make_shared<const DressingStart>(std::move(start))};
  for (const auto& make : dressing_phases) {
    std::unique_ptr<const DressingPhase> phase = make(setup);
    std::vector<LoadValue> parameters = without_values(experiment_, phase->parameters());
    const std::size_t value_count = phase->values(0).size();
    const int begin = std::exchange(count_, count_ + phase->increment_count());
    parts_.push_back({std::move(phase), std::move(parameters), begin, value_count});
  }
  worn_ = std::make_shared<const LoadState>(
      LoadState{{values(count_, false), std::make_shared<const ExperimentParameters>(experiment_.parameters),
                 scene.energies, experiment_.contacts},
                {},
                true,
                nullptr});
}

std::vector<double> DressingLoads::values(int increment, bool held) const {
  std::vector<double> all;
  for (const Part& part : parts_) {
    const std::vector<double> own =
        part.phase->values(std::clamp(increment - part.begin, 0, part.phase->increment_count()));
    all.insert(all.end(), own.begin(), own.end());
  }
  const std::vector<double> frictions = frictions_.values(friction_at(increment, held));
  all.insert(all.end(), frictions.begin(), frictions.end());
  return all;
}

DressingFriction DressingLoads::friction_at(int increment, bool held) const {
  if (increment == count_) return DressingFriction::of_experiment;
  if (experiment_.parameters.dress.friction) return DressingFriction::of_dress;
  return held && increment >= end_of("growth") ? DressingFriction::of_experiment : DressingFriction::none;
}

bool DressingLoads::can_hold() const {
  return !experiment_.parameters.dress.friction &&
         Frictions::act(frictions_.values(DressingFriction::of_experiment));
}

bool DressingLoads::has_friction(const std::vector<double>& values) const {
  return Frictions::act(std::span(values).last(friction_parameters_.size()));
}

Positions DressingLoads::forces(const Level& level, const Positions& x) const {
  return load_forces(experiment_, level, x);
}

std::shared_ptr<const LoadState> DressingLoads::at(std::vector<double> values,
                                                   const LoadState& before) const {
  auto load = std::make_shared<LoadState>(before);
  const std::span<const double> now = values, old = before.values;
  std::vector<LoadValue> set;
  for (std::size_t first = 0; const Part& part : parts_) {
    append(part.parameters, now.subspan(first, part.count), old.subspan(first, part.count), set);
    first += part.count;
  }
  const std::size_t frictions = friction_parameters_.size();
  append(friction_parameters_, now.last(frictions), old.last(frictions), set);
  ConfigErrors errors;
  set_values(experiment_, set, *load, errors);
  if (!errors.empty()) throw std::runtime_error(errors[0].message);
  for (std::size_t first = 0; const Part& part : parts_) {
    const auto own = now.subspan(first, part.count);
    if (!std::ranges::equal(own, old.subspan(first, part.count))) part.phase->apply(own, *load);
    first += part.count;
  }
  load->values = std::move(values);
  return load;
}

int DressingLoads::end_of(const std::string& phase) const {
  const auto part = std::ranges::find(parts_, phase, [](const Part& own) { return own.phase->name(); });
  return part->begin + part->phase->increment_count();
}

DressingLoads::Place DressingLoads::place(int increment) const {
  const auto part = std::ranges::find_if(
      parts_, [&](const Part& own) { return increment <= own.begin + own.phase->increment_count(); });
  return {part->phase.get(), increment - part->begin};
}

}  // namespace drape
