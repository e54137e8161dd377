#pragma once

#include "core/kernel/interfaces/material.h"
#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/declaration.h"

namespace drape {

/// Declares a material's parameters for a struct that is derived from Material.
template <class Struct>
void declare_material(Declaration<Struct>& d) {
  d.add("density", &Struct::density, "ρ, mass per volume")
      .unit("kg/m³")
      .between(1e-6, 1e6)
      .source("supplement, Table 2");
  d.add("thickness", &Struct::thickness, "d, thickness of the cloth")
      .unit("m")
      .between(bounds::smallest_length, 10)
      .source("supplement, Table 2");
  d.add("membrane_modulus", &Struct::membrane_modulus, "E_mem, Young's modulus in stretching")
      .unit("Pa")
      .between(1e-6, bounds::largest_modulus)
      .source("supplement, Table 2");
  d.add("bending_modulus", &Struct::bending_modulus, "E_bend, Young's modulus in bending")
      .unit("Pa")
      .between(0, bounds::largest_modulus)
      .source("supplement, Table 2");
  d.add("poisson_ratio", &Struct::poisson_ratio,
        "ν, of both moduli; where warp and weft differ, the geometric mean of their two Poisson's ratios")
      .at_least(0)
      .below(0.5)
      .source("supplement, Table 2");
  const auto measured = [&](const char* name, std::optional<double> Material::*member, const char* unit,
                            const char* description) {
    return d.add(name, member, description).unit(unit).between(1e-12, bounds::largest_modulus);
  };
  measured("warp_stiffness", &Material::warp_stiffness, "N/m",
           "force per width over strain of a strip along warp, in place of `membrane_modulus`; null: that "
           "modulus times the thickness");
  measured("weft_stiffness", &Material::weft_stiffness, "N/m", "the same along weft; null: as along warp")
      .only_with("warp_stiffness");
  measured("shear_stiffness", &Material::shear_stiffness, "N/m",
           "shear force per width over the angle in radians; null: as of an isotropic cloth with the mean of "
           "warp and weft");
  measured("warp_bending", &Material::warp_bending, "N m",
           "bending rigidity of a strip along warp per width, in place of `bending_modulus`; null: that "
           "modulus times d³/12");
  measured("weft_bending", &Material::weft_bending, "N m", "the same along weft; null: as along warp")
      .only_with("warp_bending");
  measured("bias_bending", &Material::bias_bending, "N m",
           "the same at 45°; null: as of an isotropic cloth with the mean of warp and weft")
      .only_with("warp_bending");
  d.add("bending_hysteresis", &Struct::bending_hysteresis,
        "2HB, width of the loop of moment against curvature: friction between yarns, which "
        "`midedge_bending` counts as on first loading and other energies leave out")
      .unit("N")
      .between(0, bounds::largest_modulus)
      .source("KES-FB2");
}

}  // namespace drape
