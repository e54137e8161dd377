#include "core/app/picture/outline.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/app/picture/sample_grid.h"
#include "core/kernel/threads/parallel.h"

namespace drape {

namespace {

constexpr float line_width = 3e-3f;  // of the picture's height
constexpr float least_width = 1.5f;  // [pixels]
constexpr float softness = 0.5f;     // half the width over which the line fades out [pixels]

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

void draw_outline(Image& image, const TriangleMesh& mesh, const Camera& camera,
                  const Eigen::Vector3f& colour) {
  const int width = split * image.width, height = split * image.height;
  const std::vector<unsigned char> covered = cover_of(mesh, camera, width, height);
  const float edge = std::max(line_width * image.height, least_width) / 2 + softness;
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
