#include <cmath>

#include "core/app/dressing/phase.h"
#include "core/app/experiment/experiment_path.h"

namespace drape {

namespace {

/// A strain limit that limits nothing, where it begins, and the increments in which it comes down.
constexpr double loosest_limit = 100;
constexpr int limit_increments = 12;

/// The strain limits of a sewn garment, whose pieces were placed beyond them, come down to what they are.
class LimitPhase final : public DressingPhase {
 public:
  explicit LimitPhase(const DressingSetup& setup) {
    const std::vector<NamedEnergy>& energies = setup.experiment.energies;
    for (std::size_t k = 0; k < energies.size(); ++k) {
      if (energies[k].energy->role() != EnergyRole::limit) continue;
      paths_.push_back("energies." + std::to_string(k) + ".limit");
      limits_.push_back(value_at(setup.experiment.resolved, paths_.back())->number);
    }
  }

  std::string name() const override { return "limit"; }
  int increment_count() const override { return paths_.empty() ? 0 : limit_increments; }
  std::vector<double> values(int increment) const override {
    if (increment == limit_increments) return limits_;
    std::vector<double> values;
    for (const double limit : limits_)  // geometric above 1
      values.push_back(1 + (loosest_limit - 1) * std::pow((limit - 1) / (loosest_limit - 1),
                                                          double(increment) / limit_increments));
    return values;
  }
  std::vector<std::string> parameters() const override { return paths_; }

 private:
  std::vector<std::string> paths_;
  std::vector<double> limits_;
};

}  // namespace

std::unique_ptr<DressingPhase> limit_phase(const DressingSetup& setup) {
  return std::make_unique<LimitPhase>(setup);
}

}  // namespace drape
