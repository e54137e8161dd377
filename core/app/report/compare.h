#pragma once

#include <string>
#include <vector>

#include "core/app/report/run_collection.h"
#include "core/kernel/plugin/config_node.h"

namespace drape {

/// What `drape compare` says.
struct Comparison {
  std::string text;     ///< for a terminal: the changes, the entries of one side only, and the broken bounds
  bool broken = false;  ///< a bound is violated, or a run with bounds no longer converges or exists
};

/// Compares two runs or sweeps quantity by quantity, matched by variation and seed (not for single runs),
/// then by method and level. A bound is "seconds=1.1": the largest admissible ratio of a quantity after to
/// before, the inverse ratio where higher is better. Throws std::runtime_error with one line for a bound that
/// says nothing, and if nothing matches, or no match has a bound's quantity.
Comparison compare(const RunCollection& before, const RunCollection& after,
                   const std::vector<std::string>& bounds);

/// The keys of an experiment that say which energy is minimised, and from where its fall is measured: the
/// start without its noise. The methods are not among them.
const std::vector<std::string>& model_keys();

/// The paths of the keys within model_keys in which two experiments differ. A key that one of them lacks is
/// no difference.
std::vector<std::string> differing_model_keys(const ConfigNode& a, const ConfigNode& b);

/// The values of model_keys as one text, which two experiments share if their energies compare.
std::string model_of(const ConfigNode& config);

}  // namespace drape
