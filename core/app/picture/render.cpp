#include "core/app/picture/render.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <thread>
#include <utility>

#include "core/app/picture/eye.h"
#include "core/app/picture/light_buffer.h"
#include "core/app/picture/lighting.h"
#include "core/app/picture/ray_scene.h"
#include "core/app/picture/sampling.h"
#include "core/kernel/threads/parallel.h"

namespace drape {

namespace {

constexpr int tile_size = 32;        // [pixels]
constexpr float edge_width = 1e-3f;  // of the picture's height
constexpr float edge_opacity = 0.5f;
constexpr int border_rays = 16;  // through a pixel where surfaces end
constexpr int light_rays = 2;    // from a pixel to each light; more would cost as much again and hardly show
enum Seed : std::uint32_t { border_seed = 0x68bc21ebu, key_seed = 0x02e5be93u, sky_seed = 0x967a889bu };

/// How much of a pixel at a point the lines along the edges of its triangle cover, with soft borders.
float edge_cover(const SurfacePoint& point, float pixel_size, int height) {
  const float half_width = std::max(edge_width * height, 0.6f) / 2, soft = 0.75f;
  const float distance = point.edge_distance.minCoeff() / pixel_size;
  return std::clamp((half_width + soft - distance) / (2 * soft), 0.0f, 1.0f);
}

/// What is seen of an obstacle through cloth: its outline more than its middle.
float show_through(const SurfacePoint& obstacle, const Ray& ray) {
  const float facing = std::clamp(-obstacle.normal.dot(ray.direction()), 0.0f, 1.0f);
  return 0.05f + 0.3f * (1 - facing) * (1 - facing);
}

/// One picture: what is seen through the pixels' centres, with random rays to the lights; the light that
/// arrives, smoothed; more rays from the eye where surfaces end.
class Painting {
 public:
  Painting(const Drawing& drawing, const Camera& camera, LightBuffer& buffer)
      : drawing_(drawing),
        scene_(drawing),
        lighting_(scene_, camera),
        eye_(camera, scene_.centre(), buffer.width(), buffer.height()),
        buffer_(buffer) {}

  void see(int column, int row) {
    Seen seen = look(column + 0.5f, row + 0.5f);
    Pixel& pixel = buffer_.pixel(column, row);
    pixel.light = seen.light;
    pixel.kind = seen.kind;
    pixel.veil = seen.veil;
    if (!seen.point) return;
    pixel.position = seen.point->position;
    pixel.normal = seen.point->normal;
    Arriving& arriving = buffer_.arriving(column, row);
    const std::uint32_t first = morton_number(column, row) * light_rays;
    for (int k = 0; k < light_rays; ++k)
      arriving += lighting_.arriving(*seen.point, sample_point(first + k, key_seed),
                                     sample_point(first + k, sky_seed));
    arriving /= light_rays;
  }

  Rgb colour(int column, int row) const {
    const Pixel& pixel = buffer_.pixel(column, row);
    if (buffer_.uniform(column, row, pixel_size(pixel.position)))
      return sum(pixel.light, buffer_.arriving(column, row));
    Rgb all = Rgb::Zero();
    for (int k = 0; k < border_rays; ++k) {
      const Eigen::Vector2f place = sample_point(k, border_seed);
      const Seen seen = look(column + 0.5f + on_tent(place[0]), row + 0.5f + on_tent(place[1]));
      Arriving arriving = Arriving::Zero();
      if (seen.point)
        arriving = buffer_.arriving_at(*seen.point, column, row, pixel_size(seen.point->position));
      all += sum(seen.light, arriving);
    }
    return all / border_rays;
  }

  float pixel_size(const Eigen::Vector3f& position) const { return eye_.pixel_size(position); }

 private:
  struct Seen {
    std::optional<SurfacePoint> point;
    Light light;
    std::uint8_t kind = 0;
    float veil = 0;
  };

  static Rgb sum(const Light& light, const Arriving& arriving) {
    return arriving[0] * light.key + arriving[1] * light.sky + light.other;
  }

  /// Through a place in the picture [pixels].
  Seen look(float column, float row) const {
    const Ray ray = eye_.through(column, row);
    Seen seen{scene_.nearest(ray), {}};
    if (!seen.point) {
      seen.light.other = Lighting::backdrop();
      return seen;
    }
    seen.kind = 1 + static_cast<std::uint8_t>(seen.point->surface);
    seen.light = lighting_.at(*seen.point, ray);
    if (seen.point->surface == SurfacePoint::Surface::cloth) add_lines(ray, seen);
    return seen;
  }

  /// Darkens cloth by its edges and, under X-rays, by the obstacle behind it.
  void add_lines(const Ray& ray, Seen& seen) const {
    float share = 0;
    if (drawing_.edges)
      share = edge_opacity * edge_cover(*seen.point, pixel_size(seen.point->position), buffer_.height());
    if (drawing_.obstacle && drawing_.xray) {
      if (const auto behind = scene_.nearest_obstacle(ray)) {
        seen.veil = show_through(*behind, ray);
        share = std::max(share, seen.veil);
      }
    }
    for (Rgb* part : {&seen.light.key, &seen.light.sky, &seen.light.other}) *part *= 1 - share;
  }

  const Drawing& drawing_;
  const RayScene scene_;
  const Lighting lighting_;
  const Eye eye_;
  LightBuffer& buffer_;
};

}  // namespace

Renderer::Renderer(int width, int height, std::function<bool()> cancelled)
    : width_(width), height_(height), cancelled_(std::move(cancelled)) {}

void Renderer::for_tiles(const std::function<void(int column, int row)>& body) const {
  const int columns = (width_ - 1) / tile_size + 1, rows = (height_ - 1) / tile_size + 1;
  const std::thread::id caller = std::this_thread::get_id();
  parallel_for(columns * rows, 1, [&](int tile, int) {
    if (cancelled_ && std::this_thread::get_id() == caller && cancelled_()) throw RenderingCancelled();
    const int left = tile % columns * tile_size, top = tile / columns * tile_size;
    for (int row = top; row < std::min(top + tile_size, height_); ++row)
      for (int column = left; column < std::min(left + tile_size, width_); ++column) body(column, row);
  });
}

Image Renderer::draw(const Drawing& drawing, const Camera& camera) const {
  LightBuffer buffer(width_, height_);
  Painting painting(drawing, camera, buffer);
  for_tiles([&](int column, int row) { painting.see(column, row); });
  buffer.smooth(painting.pixel_size(Eigen::Vector3f::Zero()));
  Image image{width_, height_, {}};
  image.pixels.resize(3 * static_cast<std::size_t>(width_) * height_);
  for_tiles([&](int column, int row) {
    const Rgb colour = painting.colour(column, row);
    const std::size_t first = 3 * (static_cast<std::size_t>(row) * width_ + column);
    for (int k = 0; k < 3; ++k) image.pixels[first + k] = srgb_byte(colour[k]);
  });
  return image;
}

}  // namespace drape
