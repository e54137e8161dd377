#include "core/app/picture/outline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/app/picture/eye.h"
#include "core/app/picture/lighting.h"
#include "core/app/picture/ray_scene.h"
#include "core/kernel/threads/parallel.h"

namespace drape {

namespace {

constexpr int split = 2;             // sub-pixels along the side of a pixel
constexpr float line_width = 3e-3f;  // of the picture's height
constexpr float least_width = 1.5f;  // [pixels]
constexpr float softness = 0.5f;     // half the width over which the line fades out [pixels]
constexpr int rows_of_piece = 8;

/// Which sub-pixels of a picture a mesh covers.
class Cover {
 public:
  Cover(const TriangleMesh& mesh, const Camera& camera, int width, int height)
      : width_(width), height_(height), covered_(static_cast<std::size_t>(width) * height) {
    const RayScene scene(Drawing{mesh});
    const Eye eye(camera, scene.centre(), width, height);
    parallel_for(height, rows_of_piece, [&](int begin, int end) {
      for (int row = begin; row < end; ++row)
        for (int column = 0; column < width; ++column)
          covered_[index(column, row)] = scene.blocked(eye.through(column + 0.5f, row + 0.5f));
    });
  }

  int height() const { return height_; }

  /// Calls body(x, y) for the middle of each border between a covered and an uncovered sub-pixel that lies to
  /// the right of or below one in this row [sub-pixels].
  template <class Body>
  void for_borders(int row, const Body& body) const {
    for (int column = 0; column < width_; ++column) {
      const unsigned char here = covered_[index(column, row)];
      if (column + 1 < width_ && covered_[index(column + 1, row)] != here) body(column + 1.0f, row + 0.5f);
      if (row + 1 < height_ && covered_[index(column, row + 1)] != here) body(column + 0.5f, row + 1.0f);
    }
  }

 private:
  std::size_t index(int column, int row) const { return static_cast<std::size_t>(row) * width_ + column; }

  int width_, height_;
  std::vector<unsigned char> covered_;  // bytes, which threads may write side by side
};

/// The squared distance of each pixel's centre in a row of the picture to the nearest border, up to `reach`;
/// greater where there is none so near [sub-pixels].
void squared_distances(const Cover& cover, int row, float reach, std::vector<float>& distances) {
  std::fill(distances.begin(), distances.end(), std::numeric_limits<float>::max());
  const float centre = split * (row + 0.5f);
  const int first = std::max(static_cast<int>(centre - reach) - 1, 0);
  const int last = std::min(static_cast<int>(centre + reach) + 1, cover.height() - 1);
  for (int sub_row = first; sub_row <= last; ++sub_row)
    cover.for_borders(sub_row, [&](float x, float y) {
      const int width = static_cast<int>(distances.size());
      const int begin = std::max(static_cast<int>(std::floor((x - reach) / split)), 0);
      const int end = std::min(static_cast<int>(std::ceil((x + reach) / split)), width);
      for (int column = begin; column < end; ++column) {
        const float across = split * (column + 0.5f) - x, down = centre - y;
        distances[column] = std::min(distances[column], across * across + down * down);
      }
    });
}

}  // namespace

void draw_outline(Image& image, const TriangleMesh& mesh, const Camera& camera,
                  const Eigen::Vector3f& colour) {
  const Cover cover(mesh, camera, split * image.width, split * image.height);
  const float edge = std::max(line_width * image.height, least_width) / 2 + softness;
  const Rgb line = linear_of_srgb(colour);
  parallel_for(image.height, rows_of_piece, [&](int begin, int end) {
    std::vector<float> distances(image.width);
    for (int row = begin; row < end; ++row) {
      squared_distances(cover, row, split * edge, distances);
      for (int column = 0; column < image.width; ++column) {
        const float inside = edge - std::sqrt(distances[column]) / split;
        if (inside <= 0) continue;
        const float share = std::min(inside / (2 * softness), 1.0f);
        unsigned char* pixel = &image.pixels[3 * (static_cast<std::size_t>(row) * image.width + column)];
        const Rgb before = linear_of_srgb(Eigen::Vector3f(pixel[0], pixel[1], pixel[2]) / 255);
        const Rgb mean = (1 - share) * before + share * line;
        for (int k = 0; k < 3; ++k) pixel[k] = srgb_byte(mean[k]);
      }
    }
  });
}

}  // namespace drape
