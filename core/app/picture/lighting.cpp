#include "core/app/picture/lighting.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace drape {

namespace {

constexpr float key_radius = 0.10f;       // tangent of half the angle under which the key light is seen
constexpr float bounce = 0.16f;           // sky light that arrives after a reflection where the sky is hidden
constexpr float floor_key_share = 0.42f;  // of the light on the floor
const Rgb key_light(0.98f, 0.92f, 0.83f), sky_light(0.40f, 0.44f, 0.50f), fill_light(0.10f, 0.13f, 0.17f);
const Rgb front_colour = linear_of_srgb({0.86f, 0.79f, 0.69f}),
          back_colour = linear_of_srgb({0.62f, 0.70f, 0.77f}),
          obstacle_colour = linear_of_srgb({0.42f, 0.44f, 0.47f}),
          backdrop = linear_of_srgb({0.985f, 0.985f, 0.985f});

/// A point in [0, 1)² for a place in the grid of samples: from M. Roberts' R2 sequence (2018), numbered along
/// a Morton curve, so that the points of every square of 2^k×2^k places are evenly spread.
Eigen::Vector2f sample_point(std::uint32_t column, std::uint32_t row) {
  const auto spread = [](std::uint32_t v) {
    for (const int shift : {8, 4, 2, 1}) v = (v | v << shift) & 0xffffffffu / ((1u << shift) + 1);
    return v;
  };
  const std::uint32_t number = spread(column) | spread(row) << 1;
  return {static_cast<float>(number * 0xc13fa9a9u >> 8) * 0x1p-24f,
          static_cast<float>(number * 0x91e10da5u >> 8) * 0x1p-24f};
}

/// [0, 1)² to directions about the unit vector n whose parts across n fill a disc of that radius evenly; the
/// part along n is that of unit vectors if the radius is 1, otherwise about 1.
Eigen::Vector3f around(const Eigen::Vector3f& n, float radius, const Eigen::Vector2f& sample) {
  const float across = radius * std::sqrt(sample[0]), turn = 2 * static_cast<float>(M_PI) * sample[1];
  const Eigen::Vector3f u = n.unitOrthogonal();
  return across * (std::cos(turn) * u + std::sin(turn) * n.cross(u)) + std::sqrt(1 - across * across) * n;
}

}  // namespace

Rgb linear_of_srgb(const Eigen::Vector3f& colour) {
  return colour.array().unaryExpr(
      [](float c) { return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f); });
}

unsigned char srgb_byte(float linear) {
  const float c = std::clamp(linear, 0.0f, 1.0f);
  const float s = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
  return static_cast<unsigned char>(std::lround(255 * s));
}

Lighting::Lighting(const RayScene& scene, const Camera& camera) : scene_(scene) {
  const Eigen::Matrix3f to_world = camera.frame.transpose().cast<float>();
  key_ = (to_world * Eigen::Vector3f(-0.75f, 0.25f, 0.25f) + Eigen::Vector3f(0, 0, 0.62f)).normalized();
  fill_ = (to_world * Eigen::Vector3f(0.8f, 0.1f, 0.45f)).normalized();
}

Rgb Lighting::to_eye(const Seen& seen, const Arriving& arriving) const {
  if (seen.surface == Seen::Surface::nothing) return backdrop;
  if (seen.surface == Seen::Surface::floor)
    return (floor_key_share * arriving[0] + (1 - floor_key_share) * arriving[1]) * backdrop;
  const Rgb base = seen.surface == Seen::Surface::obstacle ? obstacle_colour
                   : seen.front                            ? front_colour
                                                           : back_colour;
  const float key = std::max(seen.normal.dot(key_), 0.0f), side = std::max(seen.normal.dot(fill_), 0.0f);
  // A faint sheen where cloth turns away separates a fold from what lies behind it.
  const float grazing = 1 - seen.facing;
  const float sheen = 0.1f * grazing * grazing * grazing * grazing;
  return base * (arriving[0] * key * key_light + arriving[1] * (sky_light + 0.7f * side * fill_light) +
                 0.3f * side * fill_light) +
         arriving[1] * sheen;
}

Arriving Lighting::arriving(const SurfacePoint& point, int column, int row) const {
  const Eigen::Vector2f sample = sample_point(column, row);
  const auto blocked = [&](const Eigen::Vector3f& towards) {
    return scene_.blocked({point.light_origin, towards});
  };
  Arriving all(point.normal.dot(key_) > 0 && !blocked(around(key_, key_radius, sample)), bounce);
  Eigen::Vector3f towards = around(point.normal, 1, sample);
  const float out = towards.dot(point.face_normal);
  if (out < 0) towards -= 2 * out * point.face_normal;  // under the triangle: mirrored
  if (!blocked(towards)) all[1] = point.surface == Seen::Surface::floor ? 1 : 0.71f + 0.29f * towards[2];
  return all;
}

}  // namespace drape
