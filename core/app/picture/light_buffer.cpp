#include "core/app/picture/light_buffer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/kernel/threads/parallel.h"

namespace drape {

namespace {

/// 0 between pixels of one smooth surface; grows with the angle between them and with the distance of one
/// from the other's plane.
float difference(const Eigen::Vector3f& position, const Eigen::Vector3f& normal, const Pixel& other,
                 float pixel_size) {
  const float off_plane = normal.dot(other.position - position) / pixel_size;
  return 0.5f * off_plane * off_plane + 40 * (other.normal - normal).squaredNorm();
}

}  // namespace

LightBuffer::LightBuffer(int width, int height)
    : width_(width),
      height_(height),
      pixels_(static_cast<std::size_t>(width) * height),
      arriving_(pixels_.size(), Arriving::Zero()) {}

void LightBuffer::smooth(float pixel_size) {
  for (const int step : {1, 2, 4}) {
    smooth_along(step, 0, step * pixel_size);
    smooth_along(0, step, step * pixel_size);
  }
}

void LightBuffer::smooth_along(int step_x, int step_y, float pixel_size) {
  constexpr float spline[3] = {0.375f, 0.25f, 0.0625f};
  std::vector<Arriving> smoothed(arriving_);
  parallel_for(height_, 8, [&](int begin, int end) {
    for (int row = begin; row < end; ++row)
      for (int column = 0; column < width_; ++column) {
        const Pixel& here = pixel(column, row);
        if (here.kind == 0) continue;
        Arriving sum = Arriving::Zero();
        float weights = 0;
        for (int k = -2; k <= 2; ++k) {
          const int x = column + k * step_x, y = row + k * step_y;
          if (x < 0 || x >= width_ || y < 0 || y >= height_ || pixel(x, y).kind != here.kind) continue;
          const float alike =
              1 / (1 + 0.25f * difference(here.position, here.normal, pixel(x, y), pixel_size));
          const float weight = spline[std::abs(k)] * alike * alike * alike;
          sum += weight * arriving(x, y);
          weights += weight;
        }
        smoothed[index(column, row)] = sum / weights;
      }
  });
  arriving_.swap(smoothed);
}

template <class Body>
void LightBuffer::for_neighbours(int column, int row, const Body& body) const {
  for (int y = std::max(row - 1, 0); y <= std::min(row + 1, height_ - 1); ++y)
    for (int x = std::max(column - 1, 0); x <= std::min(column + 1, width_ - 1); ++x) body(x, y);
}

bool LightBuffer::uniform(int column, int row, float pixel_size) const {
  const Pixel& here = pixel(column, row);
  bool all = true;
  for_neighbours(column, row, [&](int x, int y) {
    const Pixel& there = pixel(x, y);
    all &= there.kind == here.kind && std::abs(there.veil - here.veil) < 0.04f &&
           (here.kind == 0 || difference(here.position, here.normal, there, pixel_size) < 2);
  });
  return all;
}

Arriving LightBuffer::arriving_at(const SurfacePoint& point, int column, int row, float pixel_size) const {
  Arriving found = Arriving::Ones();
  float least = std::numeric_limits<float>::infinity();
  for_neighbours(column, row, [&](int x, int y) {
    const Pixel& there = pixel(x, y);
    if (there.kind == 0) return;
    const int away = std::abs(x - column) + std::abs(y - row);
    const float value = difference(point.position, point.normal, there, pixel_size) + 0.1f * away;
    if (value >= least) return;
    least = value;
    found = arriving(x, y);
  });
  return found;
}

}  // namespace drape
