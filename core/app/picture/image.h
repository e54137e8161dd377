#pragma once

#include <string>
#include <vector>

namespace drape {

/// A picture in memory: rows from the top, three bytes (red, green, blue; sRGB) a pixel.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<unsigned char> pixels;  ///< 3·width·height
};

/// The bytes of a PNG file. Throws std::runtime_error if libpng refuses the image.
std::string encode_png(const Image& image);

}  // namespace drape
