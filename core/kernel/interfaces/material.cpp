#include "core/kernel/interfaces/material.h"

#include <cmath>

namespace drape {
namespace {

double mean(double warp, const std::optional<double>& weft) { return std::sqrt(warp * weft.value_or(warp)); }

}  // namespace

double Material::mean_membrane_modulus() const {
  return warp_stiffness ? mean(*warp_stiffness, weft_stiffness) / thickness : membrane_modulus;
}

double Material::mean_bending_modulus() const {
  return warp_bending ? 12 * mean(*warp_bending, weft_bending) / std::pow(thickness, 3) : bending_modulus;
}

}  // namespace drape
