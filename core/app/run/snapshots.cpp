#include "core/app/run/snapshots.h"

#include <bit>
#include <cstring>
#include <stdexcept>

#include "core/kernel/mesh/file.h"

namespace drape {

static_assert(std::endian::native == std::endian::little, "snapshots are written as they lie in memory");

void SnapshotRecorder::begin_level() { m_ = {}; }

void SnapshotRecorder::iteration(const Cost& cost, const Positions& x) {
  const bool wanted = most_ > 1 && m_.seen % m_.spacing == 0;
  ++m_.seen;
  if (!wanted) return;
  if (static_cast<int>(m_.snapshots.size()) == most_ - 1) {  // the last state takes one
    for (std::size_t k = 1; 2 * k < m_.snapshots.size(); ++k)
      m_.snapshots[k] = std::move(m_.snapshots[2 * k]);
    m_.snapshots.resize((m_.snapshots.size() + 1) / 2);
    m_.spacing *= 2;
    if ((m_.seen - 1) % m_.spacing != 0 || static_cast<int>(m_.snapshots.size()) == most_ - 1) return;
  }
  m_.snapshots.push_back({cost, x});
}

std::vector<Snapshot> SnapshotRecorder::end_level(const Cost& cost, const Positions& last) {
  if (!m_.snapshots.empty() && m_.snapshots.back().cost.iterations == cost.iterations)
    m_.snapshots.pop_back();
  m_.snapshots.push_back({cost, last});
  return std::move(m_.snapshots);
}

std::uint32_t write_snapshots(const std::filesystem::path& file, const std::vector<Snapshot>& snapshots) {
  std::string bytes;
  for (const Snapshot& snapshot : snapshots) {
    const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> x = snapshot.x.cast<float>();
    bytes.append(reinterpret_cast<const char*>(x.data()), sizeof(float) * x.size());
  }
  write_file(file, bytes);
  return checksum_of(bytes);
}

std::vector<Positions> read_snapshots(const std::filesystem::path& file, int vertices,
                                      std::optional<std::uint32_t> checksum) {
  const std::string bytes = read_file(file);
  const std::size_t size = sizeof(float) * 3 * vertices;
  if (size == 0 || bytes.size() % size != 0)
    throw std::runtime_error(file.string() + ": not made of snapshots of " + std::to_string(vertices) +
                             " vertices; is it cut short?");
  if (checksum && checksum_of(bytes) != *checksum)
    throw std::runtime_error(file.string() + ": is damaged: its checksum does not fit");
  std::vector<Positions> snapshots;
  for (std::size_t at = 0; at < bytes.size(); at += size) {
    Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> x(vertices, 3);
    std::memcpy(x.data(), bytes.data() + at, size);
    snapshots.push_back(x.cast<double>());
  }
  return snapshots;
}

}  // namespace drape
