#include "core/app/dressing/phase.h"

namespace drape {

namespace {

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

 private:
  const ExperimentParameters& parameters_;
  const double contraction_;
};

}  // namespace

std::unique_ptr<DressingPhase> growth_phase(const DressingSetup& setup) {
  return std::make_unique<GrowthPhase>(setup);
}

}  // namespace drape
