#include "core/model/material.h"

namespace drape {

void Material::declare(Declaration<Material>& d) {
  d.add("density", &Material::density)
      .unit("kg/m³")
      .above(0)
      .meaning("ρ, mass of a unit of volume")
      .source("supplement, Table 2");
  d.add("thickness", &Material::thickness)
      .unit("m")
      .above(0)
      .meaning("d, thickness of the cloth")
      .source("supplement, Table 2");
  d.add("membrane_modulus", &Material::membrane_modulus)
      .unit("Pa")
      .above(0)
      .meaning("E_mem, Young's modulus in stretching")
      .source("supplement, Table 2");
  d.add("bending_modulus", &Material::bending_modulus)
      .unit("Pa")
      .at_least(0)
      .meaning("E_bend, Young's modulus in bending")
      .source("supplement, Table 2");
  d.add("poisson_ratio", &Material::poisson_ratio)
      .at_least(0)
      .below(0.5)
      .meaning("ν, of both moduli")
      .source("supplement, Table 2");
}

}  // namespace drape
