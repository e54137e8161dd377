#include "core/app/dressing/phase.h"
#include "core/app/dressing/pin_support.h"
#include "core/numerics/elements/scaled_energy.h"

namespace drape {

namespace {

/// The garment gets its loads, by a factor that is the value, and pins, in place of what has supported them.
class WeightPhase final : public DressingPhase {
 public:
  explicit WeightPhase(const DressingSetup& setup)
      : energies_(setup.scene.energies), support_(pin_support(setup)) {}

  std::string name() const override { return "weight"; }
  int increment_count() const override { return 1; }
  std::vector<double> values(int increment) const override { return {double(increment)}; }

  void apply(std::span<const double> values, LoadState& load) const override {
    const double loads = values[0];
    load.energies.resize(energies_.size());
    for (std::size_t k = 0; k < energies_.size(); ++k) {
      const std::shared_ptr<const Energy>& whole = energies_[k].energy;
      if (whole->role() == EnergyRole::external) load.energies[k].energy = scaled(whole, loads);
    }
    if (support_ && loads == 0) load.energies.push_back({"pin support", support_});
    load.pins_hold = loads > 0;
    if (!load.pins_hold) load.held_at = nullptr;
  }

 private:
  const std::vector<NamedEnergy>& energies_;
  const std::shared_ptr<const Energy> support_;  // or null
};

}  // namespace

std::unique_ptr<DressingPhase> weight_phase(const DressingSetup& setup) {
  return std::make_unique<WeightPhase>(setup);
}

}  // namespace drape
