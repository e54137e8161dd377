#include "core/app/picture/sample_grid.h"

#include <cstdlib>
#include <utility>

#include "core/kernel/threads/parallel.h"

namespace drape {

namespace {

/// 1 between samples of one smooth surface; falls with the angle between them and with the distance of one
/// from the other's plane.
float likeness(const Sample& a, const Sample& b, float sample_size) {
  if (a.surface != b.surface) return 0;
  const float off_plane = a.normal.dot(b.position - a.position) / sample_size;
  const float alike = 1 / (1 + 0.125f * off_plane * off_plane + 10 * (b.normal - a.normal).squaredNorm());
  return alike * alike * alike;
}

}  // namespace

void SampleGrid::smooth(float sample_size) {
  constexpr float spline[] = {0.375f, 0.25f, 0.0625f};
  std::vector<Arriving> smoothed(samples.size());
  // Steps of 1 are left to the means over pixels.
  for (const auto& [right, down] : {std::pair(2, 0), {0, 2}, {4, 0}, {0, 4}, {8, 0}, {0, 8}}) {
    parallel_for(height, 8, [&](int begin, int end) {
      for (int row = begin; row < end; ++row)
        for (int column = 0; column < width; ++column) {
          const Sample& here = at(column, row);
          Arriving sum = Arriving::Zero();
          float weights = 0;
          for (int k = -2; k <= 2; ++k) {
            const int x = column + k * right, y = row + k * down;
            if (x < 0 || x >= width || y < 0 || y >= height) continue;
            const float weight = spline[std::abs(k)] * likeness(here, at(x, y), (right + down) * sample_size);
            sum += weight * at(x, y).arriving;
            weights += weight;
          }
          smoothed[static_cast<std::size_t>(row) * width + column] = sum / weights;
        }
    });
    for (std::size_t k = 0; k < samples.size(); ++k) samples[k].arriving = smoothed[k];
  }
}

}  // namespace drape
