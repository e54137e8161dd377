#include "core/app/picture/lighting.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/app/picture/sampling.h"

namespace drape {

namespace {

constexpr float key_radius = 0.10f;       // tangent of half the angle under which the key light is seen
constexpr float bounce = 0.16f;           // sky light that arrives after a reflection where the sky is hidden
constexpr float floor_key_share = 0.42f;  // of the light on the floor
const Rgb key_light(0.98f, 0.92f, 0.83f), sky_light(0.40f, 0.44f, 0.50f), fill_light(0.10f, 0.13f, 0.17f);
const Rgb front_colour = linear_of_srgb({0.86f, 0.79f, 0.69f}),
          back_colour = linear_of_srgb({0.62f, 0.70f, 0.77f}),
          obstacle_colour = linear_of_srgb({0.42f, 0.44f, 0.47f});

}  // namespace

Rgb linear_of_srgb(const Eigen::Vector3f& colour) {
  const auto linear = [](float c) {
    return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
  };
  return {linear(colour[0]), linear(colour[1]), linear(colour[2])};
}

unsigned char srgb_byte(float linear) {
  const float c = std::clamp(linear, 0.0f, 1.0f);
  const float s = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
  return static_cast<unsigned char>(std::lround(255 * s));
}

Rgb Lighting::backdrop() {
  static const Rgb colour = linear_of_srgb({0.985f, 0.985f, 0.985f});
  return colour;
}

Lighting::Lighting(const RayScene& scene, const Camera& camera) : scene_(scene) {
  const Eigen::Matrix3f to_world = camera.frame.transpose().cast<float>();
  key_ = (to_world * Eigen::Vector3f(-0.75f, 0.25f, 0.25f) + Eigen::Vector3f(0, 0, 0.62f)).normalized();
  tangents(key_, key_u_, key_v_);
  fill_ = (to_world * Eigen::Vector3f(0.8f, 0.1f, 0.45f)).normalized();
}

Light Lighting::at(const SurfacePoint& point, const Ray& ray) const {
  if (point.surface == SurfacePoint::Surface::floor)
    return {floor_key_share * backdrop(), (1 - floor_key_share) * backdrop(), Rgb::Zero()};
  const Rgb base = point.surface == SurfacePoint::Surface::obstacle ? obstacle_colour
                   : point.front                                    ? front_colour
                                                                    : back_colour;
  const float side = std::max(point.normal.dot(fill_), 0.0f);
  // A faint sheen where cloth turns away separates a fold from what lies behind it.
  const float grazing = 1 - std::clamp(-point.normal.dot(ray.direction()), 0.0f, 1.0f);
  const float sheen = 0.1f * grazing * grazing * grazing * grazing;
  Light light;
  light.key = base * key_light * std::max(point.normal.dot(key_), 0.0f);
  light.sky = base * (sky_light + 0.7f * side * fill_light) + sheen;
  light.other = base * 0.3f * side * fill_light;
  return light;
}

float Lighting::sky_arriving(const SurfacePoint& point, const Eigen::Vector2f& sample) const {
  Eigen::Vector3f u, v;
  tangents(point.normal, u, v);
  const Eigen::Vector2f c = on_disc(sample);
  Eigen::Vector3f towards =
      c[0] * u + c[1] * v + std::sqrt(std::max(0.0f, 1 - c.squaredNorm())) * point.normal;
  const float out = towards.dot(point.face_normal);
  if (out < 0) towards -= 2 * out * point.face_normal;  // under the triangle: mirrored
  if (scene_.blocked({point.light_origin, towards})) return bounce;
  return point.surface == SurfacePoint::Surface::floor ? 1 : 0.71f + 0.29f * towards[2];
}

Arriving Lighting::arriving(const SurfacePoint& point, const Eigen::Vector2f& key_sample,
                            const Eigen::Vector2f& sky_sample) const {
  const Eigen::Vector2f c = key_radius * on_disc(key_sample);
  const Eigen::Vector3f towards = (key_ + c[0] * key_u_ + c[1] * key_v_).normalized();
  const bool lit = point.normal.dot(key_) > 0 && !scene_.blocked({point.light_origin, towards});
  return {lit ? 1.0f : 0.0f, sky_arriving(point, sky_sample)};
}

}  // namespace drape
