#pragma once

#include <array>

namespace drape {

/// Detects that steps lead round and round through the same few states: an energy and a force residual that
/// return to those of two to eight steps before, twelve steps in a row.
///
/// A step lowers the energy of which it takes the lagged quantities as given; where these answer the step
/// with more than what they took, as friction's normal forces can, no step comes nearer to an equilibrium.
struct CycleDetector {
  static constexpr int shortest_period = 2, longest_period = 8;

  int steps = 0;  ///< noted so far
  /// Energies [J] and force residuals of the last steps; step k is at k mod (longest_period + 1).
  std::array<double, longest_period + 1> energies{}, residuals{};
  /// By period, from the shortest: consecutive steps that returned.
  std::array<int, longest_period - shortest_period + 1> returns{};

  /// Records the energy [J] and force residual at a step's end.
  void note(double energy, double residual);
  /// Whether the last steps are a cycle.
  bool cycling() const;
};

}  // namespace drape
