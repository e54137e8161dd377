#include "core/app/dressing/phase.h"
#include "core/numerics/elements/scaled_energy.h"

namespace drape {

namespace {

/// The garment gets its loads, by a factor that is the value, and pins.
class WeightPhase final : public DressingPhase {
 public:
  explicit WeightPhase(const DressingSetup& setup) : energies_(setup.scene.energies) {}

  std::string name() const override { return "weight"; }
  int increment_count() const override { return 1; }
  std::vector<double> values(int increment) const override { return {double(increment)}; }

  void apply(std::span<const double> values, LoadState& load) const override {
    const double loads = values[0];
    for (std::size_t k = 0; k < load.energies.size(); ++k) {
      const std::shared_ptr<const Energy>& whole = energies_[k].energy;
      if (whole->role() == EnergyRole::external) load.energies[k].energy = scaled(whole, loads);
    }
    load.pins_hold = loads > 0;
    if (!load.pins_hold) load.held_at = nullptr;
  }

 private:
  const std::vector<NamedEnergy>& energies_;
};

}  // namespace

std::unique_ptr<DressingPhase> weight_phase(const DressingSetup& setup) {
  return std::make_unique<WeightPhase>(setup);
}

}  // namespace drape
