#pragma once

#include <algorithm>
#include <numbers>

#include "core/kernel/interfaces/material.h"
#include "core/kernel/plugin/number_parameters.h"
#include "core/numerics/elements/orthotropic_stiffness.h"
#include "core/numerics/linear_algebra/pack_functions.h"

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

/// For a class with `Parameters`: none may have the name of a symbol, which would hide it in the formula.
#define DRAPE_IS_PARAMETER(symbol) \
  || requires(const Parameters& p) { p.symbol; }
#define DRAPE_SYMBOLS(...)                                                \
  static_assert(!(false DRAPE_FOR_EACH(DRAPE_IS_PARAMETER, __VA_ARGS__)), \
                "a parameter has the name of a symbol of the formula, which hides it: rename it")

/// What a formula depends on: evaluated on traces in place of numbers, it returns one. A comparison is a
/// trace too.
struct Trace {
  /// What it may read: where an element is at rest, how large it is, its strains, its principal stretches.
  enum Symbols : unsigned { place = 1, size = 2, strains = 4, stretches = 8 };
  int degree = 0;      ///< in the variables: 0 constant, 1 linear, 2 anything else
  unsigned reads = 0;  ///< Symbols, joined

  Trace(double = 0) {}
  Trace(int degree_in, unsigned reads_in) : degree(degree_in), reads(reads_in) {}

  friend Trace operator+(const Trace& a, const Trace& b) {
    return joined(a, b, std::max(a.degree, b.degree));
  }
  friend Trace operator-(const Trace& a, const Trace& b) { return a + b; }
  friend Trace operator-(const Trace& a) { return a; }
  friend Trace operator*(const Trace& a, const Trace& b) { return joined(a, b, a.degree + b.degree); }
  friend Trace operator/(const Trace& a, const Trace& b) { return a * of_function(b); }
  friend Trace operator!(const Trace& a) { return a; }

#define DRAPE_TRACE(function) \
  friend Trace function(const Trace& a) { return of_function(a); }
  DRAPE_FUNCTIONS(DRAPE_TRACE)
#undef DRAPE_TRACE
#define DRAPE_TRACE(function) \
  friend Trace function(const Trace& a, const Trace& b) { return of_function(a + b); }
  DRAPE_TRACE(atan2)
  DRAPE_TRACE(pow)
  DRAPE_TRACE(min)
  DRAPE_TRACE(max)
  DRAPE_TRACE(operator<)
  DRAPE_TRACE(operator<=)
  DRAPE_TRACE(operator>)
  DRAPE_TRACE(operator>=)
  DRAPE_TRACE(operator&)
  DRAPE_TRACE(operator|)
#undef DRAPE_TRACE
  friend Trace select(const Trace& condition, const Trace& a, const Trace& b) {
    return of_function(condition) + a + b;
  }

 private:
  static Trace joined(const Trace& a, const Trace& b, int degree) {
    return {std::min(degree, 2), a.reads | b.reads};
  }
  static Trace of_function(const Trace& a) { return {a.degree ? 2 : 0, a.reads}; }
};

}  // namespace drape
