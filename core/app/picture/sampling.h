#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace drape {

// Sample points for pictures: Sobol' (0,2)-sequences with hash-based Owen scrambling (B. Burley, Practical
// Hash-based Owen Scrambling, JCGT 9(4), 2020), numbered along a Morton curve through the pixels (A. Ahmed,
// P. Wonka, Screen-space blue-noise diffusion of Monte Carlo sampling error, 2020): every aligned square of
// 2^k×2^k pixels then shares one evenly spread set of points.

inline std::uint32_t reversed_bits(std::uint32_t x) {
  x = __builtin_bswap32(x);
  x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
  x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
  return (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
}

/// Laine and Karras' permutation of a binary tree whose root is the lowest bit, with Vegdahl's constants.
inline std::uint32_t scrambled_from_lowest(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  return x ^ x * 0x53a22864u;
}

/// The same with the highest bit as the root.
inline std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
  return reversed_bits(scrambled_from_lowest(reversed_bits(x), seed));
}

/// Point number `index` of a sequence in [0, 1)²; another seed gives an independent sequence.
inline Eigen::Vector2f sample_point(std::uint32_t index, std::uint32_t seed) {
  const std::uint32_t i = scrambled(index, seed);
  // The second generator matrix is Pascal's triangle mod 2: sums over supersets of bits.
  std::uint32_t j = i;
  j ^= j >> 1 & 0x55555555u;
  j ^= j >> 2 & 0x33333333u;
  j ^= j >> 4 & 0x0f0f0f0fu;
  j ^= j >> 8 & 0x00ff00ffu;
  j ^= j >> 16;
  const std::uint32_t x = reversed_bits(scrambled_from_lowest(i, seed ^ 0x9e3779b9u));
  const std::uint32_t y = reversed_bits(scrambled_from_lowest(j, seed ^ 0x85ebca6bu));
  return {static_cast<float>(x >> 8) * 0x1p-24f, static_cast<float>(y >> 8) * 0x1p-24f};
}

/// Number of a pixel along the Morton curve; coordinates below 2^16.
inline std::uint32_t morton_number(std::uint32_t x, std::uint32_t y) {
  const auto spread = [](std::uint32_t v) {
    v = (v | v << 8) & 0x00ff00ffu;
    v = (v | v << 4) & 0x0f0f0f0fu;
    v = (v | v << 2) & 0x33333333u;
    return (v | v << 1) & 0x55555555u;
  };
  return spread(x) | spread(y) << 1;
}

/// [0, 1)² to the unit disc, by P. Shirley and K. Chiu's concentric map, which keeps neighbours.
inline Eigen::Vector2f on_disc(const Eigen::Vector2f& u) {
  const Eigen::Vector2f c = 2 * u - Eigen::Vector2f::Ones();
  if (c.isZero(0)) return {0, 0};
  constexpr float quarter = 0.78539816f;
  const bool wide = std::abs(c[0]) > std::abs(c[1]);
  const float radius = wide ? c[0] : c[1];
  const float angle = wide ? quarter * c[1] / c[0] : 2 * quarter - quarter * c[0] / c[1];
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// [0, 1) to (-1, 1), densest at 0: a tent.
inline float on_tent(float u) { return u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 - 2 * u); }

/// Two unit vectors that are perpendicular to the unit vector n and to each other (T. Duff et al., Building
/// an Orthonormal Basis, Revisited, JCGT 6(1), 2017).
inline void tangents(const Eigen::Vector3f& n, Eigen::Vector3f& a, Eigen::Vector3f& b) {
  const float sign = std::copysign(1.0f, n[2]), s = -1 / (sign + n[2]), t = n[0] * n[1] * s;
  a = {1 + sign * n[0] * n[0] * s, sign * t, -sign * n[0]};
  b = {t, sign + n[1] * n[1] * s, -n[1]};
}

}  // namespace drape
