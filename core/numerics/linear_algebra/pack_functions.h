#pragma once

#include <bit>
#include <cmath>
#include <limits>

#include "core/numerics/linear_algebra/pack.h"

namespace drape {

namespace pack_detail {
// c[0] + x (c[1] + x (c[2] + …))
template <int W, int N>
Pack<W> horner(Pack<W> x, const double (&c)[N]) {
  Pack<W> sum = c[N - 1];
  for (int i = N - 2; i >= 0; --i) sum = sum * x + c[i];
  return sum;
}
}  // namespace pack_detail

/// Natural logarithm to 1 ulp, with the special values of std::log (fdlibm's e_log.c).
template <int W>
Pack<W> log(Pack<W> a) {
  using Lanes = typename Pack<W>::Lanes;
  using Bits = pack_detail::Bits<W>;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto tiny = a < std::numeric_limits<double>::min();
  const Pack<W> scaled = select(tiny, a * 0x1p54, a);
  Bits bits = (Bits)scaled.v;
  // a = 2^k (1 + f), 1 + f in [√½, √2): adding what √½ lacks to 1 carries into the exponent from √2 on.
  constexpr long long one = 0x3ff0000000000000, root_half = 0x3fe6a09e667f3bcd;
  bits += one - root_half;
  const Bits exponent = (bits >> 52) - 1023;
  const Pack<W> f = Pack<W>::of((Lanes)((bits & 0x000fffffffffffff) + root_half)) - 1.0;
  constexpr double magic = 0x1.8p52;  // adding it to an integer leaves the integer in the low bits
  const Pack<W> k = Pack<W>::of((Lanes)(exponent + std::bit_cast<long long>(magic))) - magic -
                    select(tiny, 54.0, Pack<W>(0.0));

  const Pack<W> s = f / (2.0 + f), z = s * s, half_square = 0.5 * f * f;
  const Pack<W> r = z * pack_detail::horner(
                            z, {6.666666666666735130e-01, 3.999999999940941908e-01, 2.857142874366239149e-01,
                                2.222219843214978396e-01, 1.818357216161805012e-01, 1.531383769920937332e-01,
                                1.479819860511658591e-01});
  constexpr double ln2_high = 6.93147180369123816490e-01, ln2_low = 1.90821492927058770002e-10;
  Pack<W> result = k * ln2_high - ((half_square - (s * (half_square + r) + k * ln2_low)) - f);
  result = select(a == infinity, a, result);
  result = select(a == 0.0, -infinity, result);
  return select(a >= 0.0, result, std::numeric_limits<double>::quiet_NaN());
}

/// Angle of (x, y) to 2 ulp, with the signs of std::atan2; NaN if both are infinite.
/// Polynomial: fdlibm's s_atan.c.
template <int W>
Pack<W> atan2(Pack<W> y, Pack<W> x) {
  using Bits = pack_detail::Bits<W>;
  const Pack<W> ax = abs(x), ay = abs(y), large = max(ax, ay), small = min(ax, ay);
  // tan(t) = small / large; above tan(π/8), through tan(t - π/4).
  const auto upper = small > 0.41421356237309503 * large;
  const Pack<W> numerator = select(upper, small - large, small);
  const Pack<W> denominator = select(upper, small + large, large);
  const Pack<W> q = numerator / select(large == 0.0, 1.0, denominator), z = q * q;
  const Pack<W> tail =
      q * z *
      pack_detail::horner(
          z, {3.33333333333329318027e-01, -1.99999999998764832476e-01, 1.42857142725034663711e-01,
              -1.11111104054623557880e-01, 9.09088713343650656196e-02, -7.69187620504482999495e-02,
              6.66107313738753120669e-02, -5.83357013379057348645e-02, 4.97687799461593236017e-02,
              -3.65315727442169155270e-02, 1.62858201153657823623e-02});
  constexpr double pi = 3.14159265358979311600, pi_low = 1.22464679914735320717e-16;
  Pack<W> t = select(upper, pi / 4 - ((tail - pi_low / 4) - q), q - tail);
  t = select(ay > ax, pi / 2 - (t - pi_low / 2), t);
  const PackMask<W> left = {(Bits)x.v < 0};
  t = select(left, pi - (t - pi_low), t);
  return select((x == x) & (y == y), with_sign(t, y), std::numeric_limits<double>::quiet_NaN());
}

/// F(name) for the functions of one number that a Pack takes from the standard library, lane by lane.
#define DRAPE_STANDARD_FUNCTIONS(F) \
  F(exp) F(expm1) F(log1p) F(sin) F(cos) F(tan) F(asin) F(acos) F(atan) F(sinh) F(cosh) F(tanh)
/// F(name) for all functions of one number that a formula may call.
#define DRAPE_FUNCTIONS(F) DRAPE_STANDARD_FUNCTIONS(F) F(sqrt) F(log) F(abs) F(sign)

#define DRAPE_IN_LANES(function)                                \
  template <int W>                                              \
  Pack<W> function(Pack<W> a) {                                 \
    for (int i = 0; i < W; ++i) a.v[i] = std::function(a.v[i]); \
    return a;                                                   \
  }
DRAPE_STANDARD_FUNCTIONS(DRAPE_IN_LANES)
#undef DRAPE_IN_LANES

template <int W>
Pack<W> pow(Pack<W> a, const std::type_identity_t<Pack<W>>& b) {
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
