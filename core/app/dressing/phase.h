#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/app/dressing/dressing_start.h"
#include "core/app/scene/load_state.h"

namespace drape {

/// What the phases of a dressing are made from; they refer to the experiment and to the scene.
struct DressingSetup {
  const Experiment& experiment;
  const Scene& scene;
  std::shared_ptr<const DressingStart> start;
};

/// A phase of a dressing: values that change in its increments, which come one phase after another, and what
/// a load is by them. In the increments of other phases they stay as they are at its own first or last.
class DressingPhase {
 public:
  virtual ~DressingPhase() = default;

  virtual std::string name() const = 0;
  /// 0 for a phase that the experiment does not have.
  virtual int increment_count() const = 0;
  /// The values at the end of an increment of this phase; of 0, before it begins.
  virtual std::vector<double> values(int increment) const = 0;
  /// The paths of the experiment's parameters that the first of the values set.
  virtual std::vector<std::string> parameters() const { return {}; }
  /// Gives a load what else depends on the values.
  virtual void apply([[maybe_unused]] std::span<const double> values,
                     [[maybe_unused]] LoadState& load) const {}
  /// Why a garment at x, on the coarsest level, cannot go on from this increment, 1 or more; empty if it can.
  virtual std::string fault([[maybe_unused]] int increment, [[maybe_unused]] bool complete,
                            [[maybe_unused]] const LoadState& load,
                            [[maybe_unused]] const Positions& x) const {
    return "";
  }
};

std::unique_ptr<DressingPhase> growth_phase(const DressingSetup& setup);
std::unique_ptr<DressingPhase> sewing_phase(const DressingSetup& setup);
std::unique_ptr<DressingPhase> limit_phase(const DressingSetup& setup);
std::unique_ptr<DressingPhase> weight_phase(const DressingSetup& setup);

/// Makes the phases, in their order.
inline constexpr auto dressing_phases = {growth_phase, sewing_phase, limit_phase, weight_phase};

}  // namespace drape
