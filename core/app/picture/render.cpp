#include "core/app/picture/render.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <thread>
#include <utility>

#include "core/app/picture/ray_scene.h"
#include "core/kernel/threads/parallel.h"

namespace drape {

namespace {

using Rgb = Eigen::Array3f;  // linear light

Rgb linear_of_srgb(const Eigen::Vector3f& colour) {
  return colour.array().unaryExpr(
      [](float c) { return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f); });
}

unsigned char srgb_byte(float linear) {
  const float c = std::clamp(linear, 0.0f, 1.0f);
  const float s = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
  return static_cast<unsigned char>(std::lround(255 * s));
}

constexpr float key_radius = 0.10f;       // tangent of half the angle under which the key light is seen
constexpr float bounce = 0.16f;           // sky light that arrives after a reflection where the sky is hidden
constexpr float floor_key_share = 0.42f;  // of the light on the floor
const Rgb key_light(0.98f, 0.92f, 0.83f), sky_light(0.40f, 0.44f, 0.50f), fill_light(0.10f, 0.13f, 0.17f);
const Rgb front_colour = linear_of_srgb({0.86f, 0.79f, 0.69f}),
          back_colour = linear_of_srgb({0.62f, 0.70f, 0.77f}),
          obstacle_colour = linear_of_srgb({0.42f, 0.44f, 0.47f}),
          light_backdrop = linear_of_srgb({0.985f, 0.985f, 0.985f}),
          dark_backdrop = linear_of_srgb({0.09f, 0.105f, 0.13f});

constexpr int split = 2;  // samples along the side of a pixel
// Weights, along a row or a column, of the samples around a pixel's middle: a tent.
constexpr float tent[2 * split] = {0.125f, 0.375f, 0.375f, 0.125f};
constexpr float edge_width = 1e-3f, seam_width = 2.2e-3f;  // of the picture's height
constexpr float edge_opacity = 0.5f, seam_opacity = 0.75f;
constexpr float outline_width = 3e-3f;       // of the picture's height
constexpr float least_outline_width = 1.5f;  // [pixels]
constexpr float softness = 0.5f;             // half the width over which the line fades out [pixels]

/// What is seen of an obstacle through cloth: its outline more than its middle.
float show_through(const SurfacePoint& obstacle) {
  return 0.05f + 0.3f * (1 - obstacle.facing) * (1 - obstacle.facing);
}

template <class T>
using Grid = Eigen::Array<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;  // rows from the top

/// Calls body(column, row) for all places of a grid, row by row, on all threads.
template <class Body>
void for_places(int width, int height, const std::function<bool()>& cancelled, const Body& body) {
  const std::thread::id caller = std::this_thread::get_id();
  parallel_for(height, 1, [&](int row, int) {
    if (cancelled && std::this_thread::get_id() == caller && cancelled()) throw RenderingCancelled();
    for (int column = 0; column < width; ++column) body(column, row);
  });
}

/// The shares of the key light and of the sky light that arrive.
using Arriving = Eigen::Array2f;

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

/// What a ray through a place in the picture meets, and the light that arrives there.
struct Sample : Seen {
  float share = 1;  // of its light that edges and an obstacle behind let through
  Arriving arriving = Arriving::Zero();
};

/// 1 between samples of one smooth surface; falls with the angle between them and with the distance of one
/// from the other's plane.
float likeness(const Sample& a, const Sample& b, float sample_size) {
  if (a.surface != b.surface) return 0;
  const float off_plane = a.normal.dot(b.position - a.position) / sample_size;
  const float alike = 1 / (1 + 0.125f * off_plane * off_plane + 10 * (b.normal - a.normal).squaredNorm());
  return alike * alike * alike;
}

/// One picture: what is seen through a grid of samples, with random rays to the lights; the light that
/// arrives, smoothed; means over the samples around a pixel's middle.
class Painting {
 public:
  Painting(const Drawing& drawing, const Camera& camera, int width, int height)
      : drawing_(drawing), camera_(camera), scene_(drawing), samples_(split * height, split * width) {
    const Eigen::Matrix3f to_world = camera.frame.transpose().cast<float>();
    key_ = (to_world * Eigen::Vector3f(-0.75f, 0.25f, 0.25f) + Eigen::Vector3f(0, 0, 0.62f)).normalized();
    fill_ = (to_world * Eigen::Vector3f(0.8f, 0.1f, 0.45f)).normalized();
    const Colours& colours = drawing.colours;
    front_ = colours.cloth ? linear_of_srgb(*colours.cloth) : front_colour;
    back_ = colours.cloth ? Rgb(0.5f * (front_ + back_colour)) : back_colour;
    backdrop_ = colours.dark ? dark_backdrop : light_backdrop;
  }

  void see(int column, int row) {
    for (int y = split * row; y < split * (row + 1); ++y)
      for (int x = split * column; x < split * (column + 1); ++x) {
        const Ray ray =
            scene_.through(camera_, (2 * x + 1.0) / samples_.cols() - 1, 1 - (2 * y + 1.0) / samples_.rows());
        const std::optional<SurfacePoint> point = scene_.nearest(ray);
        if (point) samples_(y, x) = {*point, share(*point, ray), arriving(*point, x, y)};
      }
  }

  /// Takes the noise of few random rays out of the light that arrives, by means over neighbours on the same
  /// smooth surface (H. Dammertz et al., Edge-avoiding À-Trous wavelet transform, HPG 2010).
  void smooth() {
    constexpr float spline[] = {0.375f, 0.25f, 0.0625f};
    const int width = static_cast<int>(samples_.cols()), height = static_cast<int>(samples_.rows());
    const float distance = sample_size(scene_.through(camera_, 0, 0).origin().norm());  // about
    Grid<Arriving> smoothed(height, width);
    // Steps of 1 are left to the means over pixels.
    for (const auto& [right, down] : {std::pair(2, 0), {0, 2}, {4, 0}, {0, 4}, {8, 0}, {0, 8}}) {
      for_places(width, height, {}, [&](int column, int row) {
        Arriving sum = Arriving::Zero();
        float weights = 0;
        for (int k = -2; k <= 2; ++k) {
          const int x = column + k * right, y = row + k * down;
          if (x < 0 || x >= width || y < 0 || y >= height) continue;
          const float alike = likeness(samples_(row, column), samples_(y, x), (right + down) * distance);
          sum += spline[std::abs(k)] * alike * samples_(y, x).arriving;
          weights += spline[std::abs(k)] * alike;
        }
        smoothed(row, column) = sum / weights;
      });
      for (Eigen::Index k = 0; k < samples_.size(); ++k) samples_.data()[k].arriving = smoothed.data()[k];
    }
  }

  Rgb colour(int column, int row) const {
    Rgb sum = Rgb::Zero();
    for (int k = 0; k < 4 * split * split; ++k) {
      const int x = k % (2 * split), y = k / (2 * split);
      const Sample& sample =
          samples_(std::clamp<Eigen::Index>(split * row + y - split / 2, 0, samples_.rows() - 1),
                   std::clamp<Eigen::Index>(split * column + x - split / 2, 0, samples_.cols() - 1));
      sum += tent[x] * tent[y] * (sample.share * to_eye(sample));
    }
    return sum;
  }

 private:
  /// The distance between samples on a surface that faces the eye, that far away [m].
  float sample_size(double distance) const {
    return static_cast<float>(2 * camera_.tangent[1] / samples_.rows() * distance);
  }

  /// From what a ray from the eye meets back to the eye; nothing and the lit floor are one backdrop.
  Rgb to_eye(const Sample& seen) const {
    const Arriving& arriving = seen.arriving;
    if (seen.surface == Seen::Surface::nothing) return backdrop_;
    if (seen.surface == Seen::Surface::floor)
      return (floor_key_share * arriving[0] + (1 - floor_key_share) * arriving[1]) * backdrop_;
    const Rgb base = seen.surface == Seen::Surface::obstacle ? obstacle_colour : seen.front ? front_ : back_;
    const float key = std::max(seen.normal.dot(key_), 0.0f), side = std::max(seen.normal.dot(fill_), 0.0f);
    // A faint sheen where cloth turns away separates a fold from what lies behind it.
    const float grazing = 1 - seen.facing;
    const float sheen = 0.1f * grazing * grazing * grazing * grazing;
    return base * (arriving[0] * key * key_light + arriving[1] * (sky_light + 0.7f * side * fill_light) +
                   0.3f * side * fill_light) +
           arriving[1] * sheen;
  }

  /// By one random ray to each light, for a place in the grid of samples.
  Arriving arriving(const SurfacePoint& point, int column, int row) const {
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

  /// What cloth's edges and, under X-rays, obstacles behind it leave of its light.
  float share(const SurfacePoint& point, const Ray& ray) const {
    float taken = 0;
    if (point.surface != Seen::Surface::cloth) return 1;
    // What a line with soft borders takes, at a distance from its middle in space.
    const auto line = [&](float distance, float width, float opacity) {
      const float half_width = std::max(width * samples_.rows(), 0.6f * split) / 2, soft = 0.25f * split;
      distance /= sample_size(point.distance);
      taken = std::max(taken, opacity * std::clamp((half_width + soft - distance) / (2 * soft), 0.0f, 1.0f));
    };
    if (drawing_.edges) line(point.edge_distance.minCoeff(), edge_width, edge_opacity);
    for (int k = 0; k < 3 && !drawing_.seams.empty(); ++k)
      if (drawing_.seams[point.triangle] >> k & 1) line(point.edge_distance[k], seam_width, seam_opacity);
    if (drawing_.xray)
      if (const auto behind = scene_.nearest_obstacle(ray)) taken = std::max(taken, show_through(*behind));
    return 1 - taken;
  }

  const Drawing& drawing_;
  const Camera& camera_;
  const RayScene scene_;
  // Towards a warm key light of some width from the upper left of the picture, and a faint fill light from
  // the right. The sky is brighter above than below.
  Eigen::Vector3f key_, fill_;
  Rgb front_, back_, backdrop_;
  Grid<Sample> samples_;
};

/// Which samples of a picture a mesh covers.
Grid<bool> cover_of(const TriangleMesh& mesh, const Camera& camera, int width, int height) {
  Grid<bool> covered(height, width);
  const RayScene scene(Drawing{mesh});
  for_places(width, height, {}, [&](int column, int row) {
    covered(row, column) =
        scene.blocked(scene.through(camera, (2 * column + 1.0) / width - 1, 1 - (2 * row + 1.0) / height));
  });
  return covered;
}

}  // namespace

std::string encode_png(const Image& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = image.width;
  header.height = image.height;
  header.format = PNG_FORMAT_RGB;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(header), 0);
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr))
    throw std::runtime_error(std::string("cannot encode a picture: ") + header.message);
  bytes.resize(size);
  return bytes;
}

Image render(const Drawing& drawing, const Camera& camera, int width, int height,
             const std::function<bool()>& cancelled) {
  Painting painting(drawing, camera, width, height);
  for_places(width, height, cancelled, [&](int column, int row) { painting.see(column, row); });
  painting.smooth();
  Image image{width, height, {}};
  image.pixels.resize(3 * static_cast<std::size_t>(width) * height);
  for_places(width, height, cancelled, [&](int column, int row) {
    const Rgb colour = painting.colour(column, row);
    const std::size_t first = 3 * (static_cast<std::size_t>(row) * width + column);
    for (int k = 0; k < 3; ++k) image.pixels[first + k] = srgb_byte(colour[k]);
  });
  return image;
}

void draw_outline(Image& image, const TriangleMesh& mesh, const Camera& camera,
                  const Eigen::Vector3f& colour) {
  const int width = split * image.width, height = split * image.height;
  const Grid<bool> covered = cover_of(mesh, camera, width, height);
  const float edge = std::max(outline_width * image.height, least_outline_width) / 2 + softness;
  // The squared distance of each pixel's centre to the nearest border between a covered and an uncovered
  // sample, as far as the line reaches [pixels].
  Grid<float> distances = Grid<float>::Constant(image.height, image.width, edge * edge);
  const auto add_border = [&](float x, float y) {
    x /= split, y /= split;
    const int last_row = std::min(static_cast<int>(y + edge), image.height - 1),
              last_column = std::min(static_cast<int>(x + edge), image.width - 1);
    for (int row = std::max(static_cast<int>(y - edge), 0); row <= last_row; ++row)
      for (int column = std::max(static_cast<int>(x - edge), 0); column <= last_column; ++column) {
        const float across = column + 0.5f - x, down = row + 0.5f - y;
        distances(row, column) = std::min(distances(row, column), across * across + down * down);
      }
  };
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const bool here = covered(row, column);
      if (column + 1 < width && covered(row, column + 1) != here) add_border(column + 1.0f, row + 0.5f);
      if (row + 1 < height && covered(row + 1, column) != here) add_border(column + 0.5f, row + 1.0f);
    }
  const Rgb line = linear_of_srgb(colour);
  for (Eigen::Index k = 0; k < distances.size(); ++k) {
    const float share = std::min((edge - std::sqrt(distances.data()[k])) / (2 * softness), 1.0f);
    if (share <= 0) continue;
    unsigned char* pixel = &image.pixels[3 * k];
    const Rgb before = linear_of_srgb(Eigen::Vector3f(pixel[0], pixel[1], pixel[2]) / 255);
    const Rgb mean = (1 - share) * before + share * line;
    for (int c = 0; c < 3; ++c) pixel[c] = srgb_byte(mean[c]);
  }
}

}  // namespace drape
