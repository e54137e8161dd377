#include "core/app/report/recorded_snapshots.h"

#include <stdexcept>

#include "core/kernel/files/string_utils.h"

namespace drape {

namespace {

/// Why a level has fewer snapshots than an animation needs, with a remedy.
std::string fault_of_snapshots(const MethodRecord& method, const LevelRecord& level, std::size_t count,
                               std::size_t least) {
  const std::string name = "level " + std::to_string(level.level);
  if (count == 0) return "the run has no snapshots of " + name + "; run the experiment with snapshots: 8";
  if (level.iterations.value_or(0) > 1)
    return "the run has only the last state of " + name + "; run the experiment with snapshots: 8";
  std::vector<std::string> others;
  for (const LevelRecord& other : method.levels)
    if (other.snapshots.iterations.size() >= least)
      others.push_back("--level " + std::to_string(other.level));
  return name + " of " + method.name +
         " took no more than one iteration, so it has no state before its last; " +
         (others.empty() ? "export it without --frames" : "choose " + joined(others));
}

}  // namespace

SnapshotFile recorded_snapshots(const RunData& run, const LevelRecord& level, Eigen::Index n) {
  const SnapshotRecord& record = level.snapshots;
  if (record.file.empty()) return {};
  const std::filesystem::path file = run.folder / record.file;
  if (record.iterations.size() != record.seconds.size())
    throw std::runtime_error(file.string() + ": results.json has other numbers of iterations and seconds");
  return {file, record.iterations.size(), n, record.checksum};
}

std::vector<Positions> snapshot_positions(const RunData& run, const MethodRecord& method,
                                          const LevelRecord& level, Eigen::Index n, std::size_t least) {
  const SnapshotFile states = recorded_snapshots(run, level, n);
  if (states.count() < least)
    throw std::runtime_error("--frames: " + fault_of_snapshots(method, level, states.count(), least));
  std::vector<Positions> all;
  for (std::size_t k = 0; k < states.count(); ++k) all.push_back(states.positions(k));
  return all;
}

}  // namespace drape
