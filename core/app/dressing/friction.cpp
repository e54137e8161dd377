#include "core/app/dressing/friction.h"

#include <algorithm>

#include "core/app/experiment/experiment_path.h"

namespace drape {

Frictions::Frictions(const Experiment& e) {
  const ExperimentParameters& p = e.parameters;
  const double of_dress = p.dress.friction.value_or(0);
  if (p.friction > 0 || of_dress > 0) {
    paths_.emplace_back("friction");
    of_experiment_.push_back(p.friction);
    of_dress_.push_back(of_dress);
  }
  for (std::size_t k = 0; k < p.obstacles.size(); ++k) {
    const std::string path = "obstacles." + std::to_string(k) + ".friction";
    const ConfigNode* own = value_at(e.resolved, path);
    if (!own || !own->is_number()) continue;
    paths_.push_back(path);
    of_experiment_.push_back(own->number);
    of_dress_.push_back(of_dress > 0 ? own->number : 0);
  }
}

std::vector<double> Frictions::values(DressingFriction acting) const {
  if (acting == DressingFriction::none) return std::vector<double>(paths_.size(), 0);
  return acting == DressingFriction::of_dress ? of_dress_ : of_experiment_;
}

bool Frictions::act(std::span<const double> values) {
  return std::ranges::any_of(values, [](double value) { return value > 0; });
}

}  // namespace drape
