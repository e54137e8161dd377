#include "core/kernel/interfaces/material.h"

#include "core/kernel/plugin/bounds.h"

namespace drape {

void Material::declare(Declaration<Material>& d) {
  d.add("density", &Material::density)
      .unit("kg/m³")
      .at_least(1e-6)
      .at_most(1e6)
      .description("ρ, mass per volume")
      .source("supplement, Table 2");
  d.add("thickness", &Material::thickness)
      .unit("m")
      .at_least(bounds::smallest_length)
      .at_most(10)
      .description("d, thickness of the cloth")
      .source("supplement, Table 2");
  d.add("membrane_modulus", &Material::membrane_modulus)
      .unit("Pa")
      .at_least(1e-6)
      .at_most(bounds::largest_modulus)
      .description("E_mem, Young's modulus in stretching")
      .source("supplement, Table 2");
  d.add("bending_modulus", &Material::bending_modulus)
      .unit("Pa")
      .at_least(0)
      .at_most(bounds::largest_modulus)
      .description("E_bend, Young's modulus in bending")
      .source("supplement, Table 2");
  d.add("poisson_ratio", &Material::poisson_ratio)
      .at_least(0)
      .below(0.5)
      .description("ν, of both moduli")
      .source("supplement, Table 2");
}

}  // namespace drape
