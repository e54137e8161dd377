#include "core/app/report/recorded_snapshots.h"

#include <optional>
#include <stdexcept>

#include "core/app/files/json_file.h"
#include "core/kernel/files/file.h"

namespace drape {

Snapshots recorded_snapshots(const std::filesystem::path& folder, const nlohmann::ordered_json& level,
                             Eigen::Index n) {
  if (!level.contains("snapshots") || !level["snapshots"].is_object()) return {};
  const nlohmann::ordered_json& entry = level["snapshots"];
  const std::filesystem::path file = folder / entry.at("file").get<std::string>();
  const nlohmann::ordered_json &iterations = entry.at("iterations"), &seconds = entry.at("seconds");
  if (iterations.size() != seconds.size())
    throw std::runtime_error(file.string() + ": results.json has other numbers of iterations and seconds");
  std::optional<std::uint32_t> checksum;
  if (entry.contains("checksum")) checksum = entry["checksum"].get<std::uint32_t>();
  return {SnapshotFile(file, iterations.size(), n, checksum), iterations, seconds};
}

std::vector<Positions> snapshot_positions(const RunData& run, const MethodRecord& method,
                                          const LevelRecord& level, Eigen::Index n, std::size_t least) {
  const nlohmann::ordered_json results = parse_json(read_file(run.folder / "results.json"));
  const nlohmann::ordered_json& entry =
      results.at("methods").at(method.name).at("levels").at(&level - method.levels.data());
  const Snapshots snapshots = recorded_snapshots(run.folder, entry, n);
  const SnapshotFile& states = snapshots.states;
  if (states.count() < least)
    throw std::runtime_error("--frames: the run has no snapshots of level " + std::to_string(level.level) +
                             "; run the experiment with snapshots: 8");
  std::vector<Positions> all;
  for (std::size_t k = 0; k < states.count(); ++k) all.push_back(states.positions(k));
  return all;
}

}  // namespace drape
