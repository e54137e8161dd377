#include "core/app/picture/image.h"

#include <png.h>

#include <stdexcept>

namespace drape {

Image shrink(const Image& image, int factor) {
  Image small{image.width / factor, image.height / factor, {}};
  small.pixels.resize(3 * static_cast<std::size_t>(small.width) * small.height);
  const int block = factor * factor;
  for (int row = 0; row < small.height; ++row) {
    for (int column = 0; column < small.width; ++column) {
      for (int channel = 0; channel < 3; ++channel) {
        int sum = block / 2;
        for (int k = 0; k < block; ++k) {
          const std::size_t y = row * factor + k / factor, x = column * factor + k % factor;
          sum += image.pixels[3 * (y * image.width + x) + channel];
        }
        small.pixels[3 * (static_cast<std::size_t>(row) * small.width + column) + channel] =
            static_cast<unsigned char>(sum / block);
      }
    }
  }
  return small;
}

std::string encode_png(const Image& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = image.width;
  header.height = image.height;
  header.format = PNG_FORMAT_RGB;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(header), 0);
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr)) {
    throw std::runtime_error(std::string("cannot encode a picture: ") + header.message);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace drape
