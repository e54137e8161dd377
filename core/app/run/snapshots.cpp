#include "core/app/run/snapshots.h"

#include "core/app/files/snapshot_file.h"
#include "core/kernel/files/file.h"

namespace drape {

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
  for (const Snapshot& snapshot : snapshots) bytes += SnapshotFile::bytes_of(snapshot.x);
  write_file(file, bytes);
  return checksum_of(bytes);
}

}  // namespace drape
