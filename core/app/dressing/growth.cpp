#include "core/app/dressing/phase.h"
#include "core/app/dressing/tightness.h"

namespace drape {

namespace {

/// A body that fits stretches the placed pieces, which are much longer than they are sewn, by less than a
/// hundredth while it grows.
constexpr double largest_placed_stretch = 0.1;

/// The contracted body grows to its size, inside the placed pieces.
class GrowthPhase final : public DressingPhase {
 public:
  explicit GrowthPhase(const DressingSetup& setup)
      : parameters_(setup.experiment.parameters), contraction_(setup.start->contraction) {}

  std::string name() const override { return "growth"; }
  int increment_count() const override { return parameters_.dress.growth; }
  std::vector<double> values(int increment) const override {
    return {contraction_, double(increment) / increment_count()};
  }
  std::vector<std::string> parameters() const override {
    const std::string body = "obstacles." + parameters_.dress.obstacle;
    return {body + ".contraction", body + ".grown"};
  }

  std::string fault(int, bool, const LoadState& load, const Positions& x) const override {
    const std::string fault = too_tight(parameters_.cloth, *load.rests[0].get(), x, largest_placed_stretch,
                                        "as it was placed, before it is sewn to its smaller size");
    return fault.empty() ? "" : fault + "is it for another body, or placed around another part of it?";
  }

 private:
  const ExperimentParameters& parameters_;
  const double contraction_;
};

}  // namespace

std::unique_ptr<DressingPhase> growth_phase(const DressingSetup& setup) {
  return std::make_unique<GrowthPhase>(setup);
}

}  // namespace drape
