#pragma once

#include <algorithm>

#include "core/numerics/linear_algebra/pack_functions.h"

namespace drape {

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
