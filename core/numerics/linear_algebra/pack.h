#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace drape {

#if defined(__AVX512F__)
inline constexpr int native_pack_width = 8;
#elif defined(__AVX__)
inline constexpr int native_pack_width = 4;
#else
inline constexpr int native_pack_width = 2;
#endif

/// GCC vector types of W doubles, W integers, and as many floats as take the same space.
template <int W>
struct VectorOf {
  typedef double Doubles __attribute__((vector_size(8 * W)));
  typedef float Floats __attribute__((vector_size(8 * W)));
  typedef long long Integers __attribute__((vector_size(8 * W)));
};

/// W booleans, one for each lane.
template <int W>
struct PackMask {
  using Lanes = typename VectorOf<W>::Integers;
  Lanes v;  ///< -1 where true, 0 where false

  bool operator[](int lane) const { return v[lane] != 0; }
  friend PackMask operator&(PackMask a, PackMask b) { return {a.v & b.v}; }
  friend PackMask operator|(PackMask a, PackMask b) { return {a.v | b.v}; }
  friend PackMask operator!(PackMask a) { return {~a.v}; }
};

/// W doubles in a SIMD register. Argument-dependent lookup finds its functions, so a kernel with
/// `using std::sqrt; sqrt(a)` works for double and Pack.
template <int W>
struct Pack {
  using Lanes = typename VectorOf<W>::Doubles;
  using Mask = PackMask<W>;
  Lanes v;

  Pack() = default;
  Pack(double s) : v(s - Lanes{}) {}
  static Pack of(Lanes v) {
    Pack p;
    p.v = v;
    return p;
  }

  double operator[](int lane) const { return v[lane]; }

  friend Pack operator+(Pack a, Pack b) { return of(a.v + b.v); }
  friend Pack operator-(Pack a, Pack b) { return of(a.v - b.v); }
  friend Pack operator*(Pack a, Pack b) { return of(a.v * b.v); }
  friend Pack operator/(Pack a, Pack b) { return of(a.v / b.v); }
  friend Pack operator-(Pack a) { return of(-a.v); }
  Pack& operator+=(Pack b) { return *this = *this + b; }
  Pack& operator-=(Pack b) { return *this = *this - b; }
  Pack& operator*=(Pack b) { return *this = *this * b; }
  Pack& operator/=(Pack b) { return *this = *this / b; }
  /// As std::min and std::max in each lane: the first argument if either is NaN.
  friend Pack min(Pack a, Pack b) { return of((b < a).v ? b.v : a.v); }
  friend Pack max(Pack a, Pack b) { return of((a < b).v ? b.v : a.v); }
  friend Mask operator<(Pack a, Pack b) { return {a.v < b.v}; }
  friend Mask operator<=(Pack a, Pack b) { return {a.v <= b.v}; }
  friend Mask operator>(Pack a, Pack b) { return {a.v > b.v}; }
  friend Mask operator>=(Pack a, Pack b) { return {a.v >= b.v}; }
  friend Mask operator==(Pack a, Pack b) { return {a.v == b.v}; }
  friend Mask operator!=(Pack a, Pack b) { return {a.v != b.v}; }
};

template <int W>
Pack<W> select(PackMask<W> m, std::type_identity_t<Pack<W>> yes, std::type_identity_t<Pack<W>> no) {
  return Pack<W>::of(m.v ? yes.v : no.v);
}
inline double select(bool m, double yes, double no) { return m ? yes : no; }

template <int W>
bool any(PackMask<W> m) {
#ifdef __AVX512F__
  if constexpr (W == 8) return _mm512_test_epi64_mask((__m512i)m.v, (__m512i)m.v) != 0;
#endif
#ifdef __AVX__
  if constexpr (W == 4) return _mm256_movemask_pd((__m256d)m.v) != 0;
#endif
  for (int i = 0; i < W; ++i)
    if (m.v[i]) return true;
  return false;
}
inline bool any(bool m) { return m; }

/// A product that a compiler must round before it is added: not to be fused with a sum, so that a sum of
/// products has the same bits wherever it is compiled. Other types than double and Pack pass as they are.
template <class T>
T rounded(const T& product) {
  return product;
}
#if defined(__x86_64__) || defined(__aarch64__)
#ifdef __x86_64__
#define DRAPE_VECTOR_REGISTER "+v"
#else
#define DRAPE_VECTOR_REGISTER "+w"
#endif
inline double rounded(double product) {
  asm("" : DRAPE_VECTOR_REGISTER(product));
  return product;
}
template <int W>
Pack<W> rounded(Pack<W> product) {
  asm("" : DRAPE_VECTOR_REGISTER(product.v));
  return product;
}
#undef DRAPE_VECTOR_REGISTER
#endif

template <int W>
Pack<W> sqrt(Pack<W> a) {  // masked, since g++ 12 takes the plain intrinsic's operand for uninitialised
#ifdef __AVX512F__
  if constexpr (W == 8) return Pack<W>::of((typename Pack<W>::Lanes)_mm512_maskz_sqrt_pd(0xff, (__m512d)a.v));
#endif
#ifdef __AVX__
  if constexpr (W == 4) return Pack<W>::of((typename Pack<W>::Lanes)_mm256_sqrt_pd((__m256d)a.v));
#endif
  for (int i = 0; i < W; ++i) a.v[i] = std::sqrt(a.v[i]);
  return a;
}

/// 1/√a to 14 bits or better; +∞ at 0.
inline double reciprocal_sqrt(double a) { return 1 / std::sqrt(a); }
template <int W>
Pack<W> reciprocal_sqrt(Pack<W> a) {
#ifdef __AVX512F__
  if constexpr (W == 8)
    return Pack<W>::of((typename Pack<W>::Lanes)_mm512_maskz_rsqrt14_pd(0xff, (__m512d)a.v));
#endif
  return 1.0 / sqrt(a);
}

/// The three numbers at base + start[i] into lane i of x, y and z.
template <int W>
void gather_rows(const double* base, const int* start, Pack<W>& x, Pack<W>& y, Pack<W>& z) {
#if defined(__AVX512F__) && defined(__AVX512VL__)
  if constexpr (W == 8) {  // rows i and i + 4 side by side, then transposed: faster than gathers of the CPU
    const auto rows = [&](int i) {
      const __m512d low = _mm512_castpd256_pd512(_mm256_maskz_loadu_pd(7, base + start[i]));
      return _mm512_insertf64x4(low, _mm256_maskz_loadu_pd(7, base + start[i + 4]), 1);
    };
    using Lanes = typename Pack<W>::Lanes;
    const Lanes a = (Lanes)rows(0), b = (Lanes)rows(1), c = (Lanes)rows(2), d = (Lanes)rows(3);
    const Lanes xz_ab = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14),
                xz_cd = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14),
                y_ab = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15),
                y_cd = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
    x.v = __builtin_shufflevector(xz_ab, xz_cd, 0, 1, 8, 9, 4, 5, 12, 13);
    y.v = __builtin_shufflevector(y_ab, y_cd, 0, 1, 8, 9, 4, 5, 12, 13);
    z.v = __builtin_shufflevector(xz_ab, xz_cd, 2, 3, 10, 11, 6, 7, 14, 15);
    return;
  }
#endif
  double lanes[3][W];
  for (int i = 0; i < W; ++i)
    for (int c = 0; c < 3; ++c) lanes[c][i] = base[start[i] + c];
  std::memcpy(&x.v, lanes[0], sizeof x.v);
  std::memcpy(&y.v, lanes[1], sizeof y.v);
  std::memcpy(&z.v, lanes[2], sizeof z.v);
}

namespace pack_detail {
template <int W>
using Bits = typename PackMask<W>::Lanes;
inline constexpr long long sign_bit = std::numeric_limits<long long>::min();
}  // namespace pack_detail

template <int W>
Pack<W> abs(Pack<W> a) {
  return Pack<W>::of((typename Pack<W>::Lanes)((pack_detail::Bits<W>)a.v & ~pack_detail::sign_bit));
}

/// `magnitude` (not negative) with the sign of `sign`; -0 counts as negative.
template <int W>
Pack<W> with_sign(Pack<W> magnitude, Pack<W> sign) {
  using Bits = pack_detail::Bits<W>;
  return Pack<W>::of((typename Pack<W>::Lanes)((Bits)magnitude.v | ((Bits)sign.v & pack_detail::sign_bit)));
}

}  // namespace drape

template <int W>
struct Eigen::NumTraits<drape::Pack<W>> : Eigen::GenericNumTraits<drape::Pack<W>> {
  using Real = drape::Pack<W>;
  using NonInteger = drape::Pack<W>;
  using Literal = double;
  using Nested = drape::Pack<W>;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1
  };
};
