#pragma once

#include <string>

#include "plugins/energy/formula/formula.h"

namespace drape::formula {

/// Throws RefusedParameters at the key if the law cannot be compiled, or if its energy, forces or stiffness
/// on a small patch of cloth at rest are not finite.
void require_computable(const Law& law, const std::string& key, const Energy& energy);

/// How far derivatives on a deformed patch are from finite differences.
std::string derivatives_remark(const Energy& energy, const Material& material);

/// Stress, moment or acceleration of a small patch at rest.
std::string rest_remark(const Energy& energy, ElementKind kind, const Material& material);

}  // namespace drape::formula
