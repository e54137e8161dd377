#include "core/app/picture/image.h"

#include <png.h>

#include <stdexcept>

namespace drape {

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

}  // namespace drape
