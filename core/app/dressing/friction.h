#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/app/experiment/experiment.h"

namespace drape {

/// Which friction acts while a garment is put on: none, that of `dress`, or the experiment's. Obstacles that
/// have their own have it whenever one acts.
enum class DressingFriction { none, of_dress, of_experiment };

/// The frictions of an experiment's contacts, for the loads of a dressing.
class Frictions {
 public:
  explicit Frictions(const Experiment& experiment);

  /// The paths of the experiment's friction, if it has any, and of the obstacles' own.
  const std::vector<std::string>& parameters() const { return paths_; }
  /// The value of each parameter.
  std::vector<double> values(DressingFriction acting) const;
  /// Whether one of these values is above 0.
  static bool act(std::span<const double> values);

 private:
  std::vector<std::string> paths_;
  std::vector<double> of_experiment_, of_dress_;
};

}  // namespace drape
