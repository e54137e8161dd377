#pragma once

#include <cmath>

#include "core/numerics/linear_algebra/pack.h"

namespace drape {

// Functions of the standard library in each lane of a Pack.
#define DRAPE_IN_LANES(function)                                \
  template <int W>                                              \
  Pack<W> function(Pack<W> a) {                                 \
    for (int i = 0; i < W; ++i) a.v[i] = std::function(a.v[i]); \
    return a;                                                   \
  }
DRAPE_IN_LANES(exp)
DRAPE_IN_LANES(expm1)
DRAPE_IN_LANES(log1p)
DRAPE_IN_LANES(sin)
DRAPE_IN_LANES(cos)
DRAPE_IN_LANES(tan)
DRAPE_IN_LANES(asin)
DRAPE_IN_LANES(acos)
DRAPE_IN_LANES(atan)
DRAPE_IN_LANES(sinh)
DRAPE_IN_LANES(cosh)
DRAPE_IN_LANES(tanh)
#undef DRAPE_IN_LANES

template <int W>
Pack<W> pow(Pack<W> a, const Pack<W>& b) {
  for (int i = 0; i < W; ++i) a.v[i] = std::pow(a.v[i], b.v[i]);
  return a;
}

/// -1, 0 or 1; NaN of NaN. T is double or a Pack.
template <class T>
T sign(const T& a) {
  const T up = select(a > 0.0, T(1.0), a);  // zero and NaN stay
  return select(a < 0.0, T(-1.0), up);
}

}  // namespace drape
