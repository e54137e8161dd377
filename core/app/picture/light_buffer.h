#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/app/picture/lighting.h"

namespace drape {

/// What is seen through the centre of a pixel.
struct Pixel {
  Light light;
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< RayScene's [m]
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  std::uint8_t kind = 0;  ///< of the surface; 0 where there is none
  float veil = 0;         ///< share of light that the obstacle behind the cloth takes
};

/// What is seen through a grid of pixels.
class LightBuffer {
 public:
  LightBuffer(int width, int height);
  int width() const { return width_; }
  int height() const { return height_; }
  Pixel& pixel(int column, int row) { return pixels_[index(column, row)]; }
  const Pixel& pixel(int column, int row) const { return pixels_[index(column, row)]; }
  Arriving& arriving(int column, int row) { return arriving_[index(column, row)]; }
  const Arriving& arriving(int column, int row) const { return arriving_[index(column, row)]; }

  /// Takes the noise of few random rays a pixel out of arriving(), by means over neighbours on the same
  /// smooth surface (H. Dammertz et al., Edge-avoiding À-Trous wavelet transform, HPG 2010). `pixel_size`: on
  /// the surfaces, about [m].
  void smooth(float pixel_size);

  /// Whether a pixel's neighbours show the same smooth surface as the pixel does.
  bool uniform(int column, int row, float pixel_size) const;

  /// The light that arrives at a point in a pixel: that of whichever of the pixel and its neighbours shows
  /// the point's surroundings.
  Arriving arriving_at(const SurfacePoint& point, int column, int row, float pixel_size) const;

 private:
  std::size_t index(int column, int row) const { return static_cast<std::size_t>(row) * width_ + column; }
  void smooth_along(int step_x, int step_y, float pixel_size);
  template <class Body>
  void for_neighbours(int column, int row, const Body& body) const;

  int width_, height_;
  std::vector<Pixel> pixels_;
  std::vector<Arriving> arriving_;
};

}  // namespace drape
