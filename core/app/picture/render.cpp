#include "core/app/picture/render.h"

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include "core/app/picture/sample_grid.h"
#include "core/kernel/threads/parallel.h"

namespace drape {

namespace {

// Weights, along a row or a column, of the samples around a pixel's middle: a tent.
constexpr float tent[2 * split] = {0.125f, 0.375f, 0.375f, 0.125f};
constexpr float edge_width = 1e-3f;  // of the picture's height
constexpr float edge_opacity = 0.5f;
constexpr float outline_width = 3e-3f;       // of the picture's height
constexpr float least_outline_width = 1.5f;  // [pixels]
constexpr float softness = 0.5f;             // half the width over which the line fades out [pixels]

/// What is seen of an obstacle through cloth: its outline more than its middle.
float show_through(const SurfacePoint& obstacle) {
  return 0.05f + 0.3f * (1 - obstacle.facing) * (1 - obstacle.facing);
}

/// One picture: what is seen through a grid of samples, with random rays to the lights; the light that
/// arrives, smoothed; means over the samples around a pixel's middle.
class Painting {
 public:
  Painting(const Drawing& drawing, const Camera& camera, int width, int height)
      : drawing_(drawing),
        camera_(camera),
        scene_(drawing),
        lighting_(scene_, camera),
        grid_(split * width, split * height) {}

  void see(int column, int row) {
    for (int y = split * row; y < split * (row + 1); ++y)
      for (int x = split * column; x < split * (column + 1); ++x) {
        const Ray ray =
            scene_.through(camera_, (2 * x + 1.0) / grid_.width - 1, 1 - (2 * y + 1.0) / grid_.height);
        const std::optional<SurfacePoint> point = scene_.nearest(ray);
        if (point) grid_.at(x, y) = {*point, share(*point, ray), lighting_.arriving(*point, x, y)};
      }
  }

  void smooth() { grid_.smooth(sample_size(scene_.through(camera_, 0, 0).origin().norm())); }

  Rgb colour(int column, int row) const {
    Rgb sum = Rgb::Zero();
    for (int k = 0; k < 4 * split * split; ++k) {
      const int x = k % (2 * split), y = k / (2 * split);
      sum += tent[x] * tent[y] *
             light(std::clamp(split * column + x - split / 2, 0, grid_.width - 1),
                   std::clamp(split * row + y - split / 2, 0, grid_.height - 1));
    }
    return sum;
  }

 private:
  /// The distance between samples on a surface that faces the eye, that far away [m].
  float sample_size(double distance) const {
    return static_cast<float>(2 * camera_.tangent[1] / grid_.height * distance);
  }

  Rgb light(int x, int y) const {
    const Sample& sample = grid_.at(x, y);
    return sample.share * lighting_.to_eye(sample, sample.arriving);
  }

  /// What cloth's edges and, under X-rays, obstacles behind it leave of its light.
  float share(const SurfacePoint& point, const Ray& ray) const {
    float taken = 0;
    if (point.surface != Seen::Surface::cloth) return 1;
    if (drawing_.edges) {  // lines along the triangle's, with soft borders
      const float half_width = std::max(edge_width * grid_.height, 0.6f * split) / 2, soft = 0.25f * split;
      const float distance = point.edge_distance.minCoeff() / sample_size(point.distance);
      taken = edge_opacity * std::clamp((half_width + soft - distance) / (2 * soft), 0.0f, 1.0f);
    }
    if (drawing_.xray)
      if (const auto behind = scene_.nearest_obstacle(ray)) taken = std::max(taken, show_through(*behind));
    return 1 - taken;
  }

  const Drawing& drawing_;
  const Camera& camera_;
  const RayScene scene_;
  const Lighting lighting_;
  SampleGrid grid_;
};

/// Calls body for all pixels, row by row, on all threads.
void for_pixels(int width, int height, const std::function<bool()>& cancelled,
                const std::function<void(int column, int row)>& body) {
  const std::thread::id caller = std::this_thread::get_id();
  parallel_for(height, 1, [&](int row, int) {
    if (cancelled && std::this_thread::get_id() == caller && cancelled()) throw RenderingCancelled();
    for (int column = 0; column < width; ++column) body(column, row);
  });
}

/// Which samples of a picture a mesh covers, row by row.
std::vector<unsigned char> cover_of(const TriangleMesh& mesh, const Camera& camera, int width, int height) {
  std::vector<unsigned char> covered(static_cast<std::size_t>(width) * height);
  const RayScene scene(Drawing{mesh});
  parallel_for(height, 8, [&](int begin, int end) {
    for (int row = begin; row < end; ++row)
      for (int column = 0; column < width; ++column)
        covered[static_cast<std::size_t>(row) * width + column] = scene.blocked(
            scene.through(camera, (2 * column + 1.0) / width - 1, 1 - (2 * row + 1.0) / height));
  });
  return covered;
}

}  // namespace

Image render(const Drawing& drawing, const Camera& camera, int width, int height,
             const std::function<bool()>& cancelled) {
  Painting painting(drawing, camera, width, height);
  for_pixels(width, height, cancelled, [&](int column, int row) { painting.see(column, row); });
  painting.smooth();
  Image image{width, height, {}};
  image.pixels.resize(3 * static_cast<std::size_t>(width) * height);
  for_pixels(width, height, cancelled, [&](int column, int row) {
    const Rgb colour = painting.colour(column, row);
    const std::size_t first = 3 * (static_cast<std::size_t>(row) * width + column);
    for (int k = 0; k < 3; ++k) image.pixels[first + k] = srgb_byte(colour[k]);
  });
  return image;
}

void draw_outline(Image& image, const TriangleMesh& mesh, const Camera& camera,
                  const Eigen::Vector3f& colour) {
  const int width = split * image.width, height = split * image.height;
  const std::vector<unsigned char> covered = cover_of(mesh, camera, width, height);
  const float edge = std::max(outline_width * image.height, least_outline_width) / 2 + softness;
  // The squared distance of each pixel's centre to the nearest border between a covered and an uncovered
  // sample, as far as the line reaches [pixels].
  std::vector<float> distances(static_cast<std::size_t>(image.width) * image.height, edge * edge);
  const auto add_border = [&](float x, float y) {
    x /= split, y /= split;
    const int last_row = std::min(static_cast<int>(y + edge), image.height - 1),
              last_column = std::min(static_cast<int>(x + edge), image.width - 1);
    for (int row = std::max(static_cast<int>(y - edge), 0); row <= last_row; ++row)
      for (int column = std::max(static_cast<int>(x - edge), 0); column <= last_column; ++column) {
        const float across = column + 0.5f - x, down = row + 0.5f - y;
        float& distance = distances[static_cast<std::size_t>(row) * image.width + column];
        distance = std::min(distance, across * across + down * down);
      }
  };
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const std::size_t here = static_cast<std::size_t>(row) * width + column;
      if (column + 1 < width && covered[here + 1] != covered[here]) add_border(column + 1.0f, row + 0.5f);
      if (row + 1 < height && covered[here + width] != covered[here]) add_border(column + 0.5f, row + 1.0f);
    }
  const Rgb line = linear_of_srgb(colour);
  for (std::size_t k = 0; k < distances.size(); ++k) {
    const float share = std::min((edge - std::sqrt(distances[k])) / (2 * softness), 1.0f);
    if (share <= 0) continue;
    unsigned char* pixel = &image.pixels[3 * k];
    const Rgb before = linear_of_srgb(Eigen::Vector3f(pixel[0], pixel[1], pixel[2]) / 255);
    const Rgb mean = (1 - share) * before + share * line;
    for (int c = 0; c < 3; ++c) pixel[c] = srgb_byte(mean[c]);
  }
}

}  // namespace drape
