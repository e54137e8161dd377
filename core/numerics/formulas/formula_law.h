#pragma once

#include <numbers>

#include "core/kernel/interfaces/material.h"
#include "core/kernel/plugin/parameters.h"
#include "core/numerics/elements/orthotropic_stiffness.h"

namespace drape {

/// The material's numbers that every formula may use.
struct MaterialSymbols {
  double E;          ///< Young's modulus of the membrane [Pa]
  double E_bend;     ///< Young's modulus in bending [Pa]
  double nu;         ///< Poisson's ratio
  double mu;         ///< Lamé's constant E / (2 (1 + ν)) [Pa]
  double lambda;     ///< Lamé's constant of plane stress, E ν / (1 - ν²) [Pa]
  double k;          ///< bending stiffness E_bend d³ / (24 (1 - ν²)), half a plate's [J]
  double rho;        ///< density [kg/m³]
  double thickness;  ///< d [m]
  static constexpr double pi = std::numbers::pi;

  explicit MaterialSymbols(const Material& m)
      : E(m.mean_membrane_modulus()),
        E_bend(m.mean_bending_modulus()),
        nu(m.poisson_ratio),
        mu(E / (2 * (1 + nu))),
        lambda(E * nu / (1 - nu * nu)),
        k(bending_stiffness(m)),
        rho(m.density),
        thickness(m.thickness) {}
};

/// What the formulas of core/numerics/formulas/energy_formula.h are functions of, beside their element: their
/// own parameters and the material. A name that both have is an error where it is used.
template <class Own = NoParameters>
struct FormulaLaw : Own, MaterialSymbols {
  using Parameters = Own;
  explicit FormulaLaw(const Own& own = {}, const Material& material = Material())
      : Own(own), MaterialSymbols(material) {}
};

}  // namespace drape
