#pragma once

#include <vector>

#include "core/app/picture/lighting.h"

namespace drape {

/// Samples along the side of a pixel.
inline constexpr int split = 2;

/// What a ray through a place in the picture meets, and the light that arrives there.
struct Sample : Seen {
  float share = 1;  ///< of its light that edges and an obstacle behind let through
  Arriving arriving = Arriving::Zero();
};

/// All samples of a picture, row by row from the top.
struct SampleGrid {
  int width = 0, height = 0;
  std::vector<Sample> samples;

  SampleGrid(int width, int height)
      : width(width), height(height), samples(static_cast<std::size_t>(width) * height) {}
  Sample& at(int column, int row) { return samples[static_cast<std::size_t>(row) * width + column]; }
  const Sample& at(int column, int row) const { return const_cast<SampleGrid*>(this)->at(column, row); }

  /// Takes the noise of few random rays out of the light that arrives, by means over neighbours on the same
  /// smooth surface (H. Dammertz et al., Edge-avoiding À-Trous wavelet transform, HPG 2010). `sample_size`:
  /// distance between samples on a surface that faces the eye, about [m].
  void smooth(float sample_size);
};

}  // namespace drape
