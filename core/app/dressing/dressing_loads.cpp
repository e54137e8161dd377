#include "core/app/dressing/dressing_loads.h"

#include <algorithm>
#include <stdexcept>

#include "core/app/experiment/experiment_path.h"

namespace drape {

DressingLoads::DressingLoads(const Experiment& experiment, const Scene& scene, DressingStart start)
    : experiment_(experiment) {
  const DressingSetup setup{experiment_, scene, std::make_shared<const DressingStart>(std::move(start))};
  const ConfigNode& resolved = experiment_.resolved;
  for (const auto& make : dressing_phases) {
    Part part{make(setup), {}, count_, 0};
    for (const std::string& path : part.phase->parameters()) {
      const std::vector<std::string> words = words_of_path(resolved, path);
      const auto item = words.size() > 1 ? resolved.find(words[0])->index_of(words[1]) : std::nullopt;
      part.parameters.push_back({path, words[0], item.value_or(0), {}, false});
    }
    count_ += part.phase->increment_count();
    part.count = part.phase->values(0).size();
    parts_.push_back(std::move(part));
  }
  worn_ = std::make_shared<const LoadState>(
      LoadState{{values(count_), std::make_shared<const ExperimentParameters>(experiment_.parameters),
                 scene.energies, experiment_.contacts},
                {},
                true,
                nullptr});
}

std::vector<double> DressingLoads::values(int increment) const {
  std::vector<double> all;
  for (const Part& part : parts_) {
    const std::vector<double> own =
        part.phase->values(std::clamp(increment - part.begin, 0, part.phase->increment_count()));
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

std::shared_ptr<const LoadState> DressingLoads::at(std::vector<double> values,
                                                   const LoadState& before) const {
  auto load = std::make_shared<LoadState>(before);
  std::vector<LoadValue> set;
  for (std::size_t first = 0; const Part& part : parts_) {
    const std::span<const double> own(&values[first], part.count), old(&before.values[first], part.count);
    for (std::size_t k = 0; k < part.parameters.size(); ++k) {
      set.push_back(part.parameters[k]);
      set.back().value = ConfigNode::of(own[k]);
      set.back().changes = own[k] != old[k];
    }
    first += part.count;
  }
  ConfigErrors errors;
  set_values(experiment_, set, *load, errors);
  if (!errors.empty()) throw std::runtime_error(errors[0].message);
  for (std::size_t first = 0; const Part& part : parts_) {
    const std::span<const double> own(&values[first], part.count), old(&before.values[first], part.count);
    if (!std::ranges::equal(own, old)) part.phase->apply(own, *load);
    first += part.count;
  }
  load->values = std::move(values);
  return load;
}

DressingLoads::Place DressingLoads::place(int increment) const {
  const auto part = std::ranges::find_if(
      parts_, [&](const Part& own) { return increment <= own.begin + own.phase->increment_count(); });
  return {part->phase.get(), increment - part->begin};
}

}  // namespace drape
