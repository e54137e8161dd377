#include "core/app/view/view_blocks.h"

#include <zlib.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace drape {

namespace {

constexpr double steps = 65535;

template <class T>
void append(std::string& bytes, T value) {
  static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

std::string encode_positions(const Positions& x) {
  Eigen::AlignedBox3d bounds = bounding_box(x);
  if (bounds.isEmpty()) bounds.extend(Eigen::Vector3d::Zero());
  const Eigen::AlignedBox3f box = bounds.cast<float>();
  std::string bytes;
  bytes.reserve(24 + 6 * x.rows());
  for (int k = 0; k < 3; ++k) append(bytes, box.min()[k]);
  for (int k = 0; k < 3; ++k) append(bytes, box.sizes()[k]);
  for (int k = 0; k < 3; ++k) {
    const double lower = box.min()[k], size = box.sizes()[k];
    std::uint16_t before = 0;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const double place = size > 0 && std::isfinite(x(i, k)) ? (x(i, k) - lower) / size : 0;
      const auto q = static_cast<std::uint16_t>(std::lround(std::clamp(place, 0.0, 1.0) * steps));
      append(bytes, static_cast<std::uint16_t>(q - before));
      before = q;
    }
  }
  return bytes;
}

std::string encode_triangles(const Triangles& triangles) {
  std::string bytes;
  bytes.reserve(4 * triangles.size());
  for (int k = 0; k < 3; ++k) {
    std::int32_t before = 0;
    for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
      append(bytes, static_cast<std::int32_t>(triangles(t, k) - before));
      before = triangles(t, k);
    }
  }
  return bytes;
}

std::string encode_scalars(const Eigen::VectorXd& values, double low, double high) {
  std::string bytes;
  bytes.reserve(8 + values.size());
  append(bytes, static_cast<float>(low));
  append(bytes, static_cast<float>(high));
  for (const double value : values) {
    const double place = std::clamp((value - low) / (high - low), 0.0, 1.0);
    append(bytes, static_cast<std::uint8_t>(std::isnan(place) ? 255 : std::lround(place * 254)));
  }
  return bytes;
}

std::string deflated(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  const int code = compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                             reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_BEST_COMPRESSION);
  if (code != Z_OK) throw std::runtime_error("zlib cannot compress a block of the viewer");
  packed.resize(size);
  return packed;
}

}  // namespace drape
