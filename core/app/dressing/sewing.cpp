#include <cmath>
#include <optional>

#include "core/app/dressing/phase.h"
#include "core/app/dressing/tightness.h"
#include "core/kernel/files/message_text.h"
#include "core/numerics/dressing/garment_rest.h"

namespace drape {

namespace {

/// The weight of the placed metric at the start, where a triangle without area still rests as one with some,
/// and in the last increment but one.
constexpr double first_weight = 0.99, least_weight = 1e-4;

/// The pieces go from the shape that they were placed in to their own: the value is the weight of the placed
/// shape's metric in that of their rest shape.
class SewingPhase final : public DressingPhase {
 public:
  explicit SewingPhase(const DressingSetup& setup)
      : parameters_(setup.experiment.parameters), scene_(setup.scene), start_(setup.start) {}

  std::string name() const override { return "sewing"; }
  int increment_count() const override { return parameters_.dress.sewing; }
  std::vector<double> values(int increment) const override {
    const int last = increment_count();
    return {increment == last ? 0
                              : first_weight * std::pow(least_weight, increment / std::max(1.0, last - 1.0))};
  }

  void apply(std::span<const double> values, LoadState& load) const override {
    load.rests.clear();
    for (int level = 0; values[0] > 0 && level < scene_.hierarchy.level_count(); ++level)
      load.rests.emplace_back([&scene = scene_, start = start_, level, weight = values[0]] {
        return with_intermediate_rest(scene.hierarchy.levels[level], start->garments[level], weight);
      });
  }

  std::string fault(int increment, bool complete, const LoadState&, const Positions& x) const override {
    const std::optional<double> allowed = parameters_.dress.largest_stretch;
    if (!allowed || increment < increment_count() || !complete) return "";
    const std::string tight = tightness_text("the garment is too tight for its body", parameters_.cloth,
                                             scene_.hierarchy.levels[0], x, *allowed);
    return tight.empty() ? ""
                         : tight + ", and " + three_digits(100 * *allowed) +
                               " % is allowed; take a larger size or a smaller body, or raise "
                               "\"dress.largest_stretch\" for a cloth that stretches so far";
  }

 private:
  const ExperimentParameters& parameters_;
  const Scene& scene_;
  const std::shared_ptr<const DressingStart> start_;
};

}  // namespace

std::unique_ptr<DressingPhase> sewing_phase(const DressingSetup& setup) {
  return std::make_unique<SewingPhase>(setup);
}

}  // namespace drape
