#include "core/app/files/snapshot_file.h"

#include <algorithm>
#include <cstring>

#include "core/kernel/files/file.h"

namespace drape {

namespace {

using Floats = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

std::size_t size_of(Eigen::Index n) { return sizeof(float) * 3 * static_cast<std::size_t>(n); }

}  // namespace

SnapshotFile::SnapshotFile(const std::filesystem::path& file, std::size_t count, Eigen::Index n,
                           std::optional<std::uint32_t> checksum)
    : bytes_(read_file(file, std::max<std::uintmax_t>(largest_file, count * size_of(n)))),
      count_(count),
      n_(n) {
  if (bytes_.size() != count * size_of(n))
    refuse_path(file, "holds " + std::to_string(bytes_.size()) + " bytes, not " + std::to_string(count) +
                          " snapshots of " + std::to_string(n) + " vertices");
  if (checksum && checksum_of(bytes_) != *checksum)
    refuse_path(file, "is damaged: its checksum does not fit");
}

Positions SnapshotFile::positions(std::size_t state) const {
  Floats x(n_, 3);
  std::memcpy(x.data(), bytes_.data() + state * size_of(n_), size_of(n_));
  return x.cast<double>();
}

std::string SnapshotFile::bytes_of(const Positions& x) {
  const Floats floats = x.cast<float>();
  return {reinterpret_cast<const char*>(floats.data()), size_of(floats.rows())};
}

}  // namespace drape
