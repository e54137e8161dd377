#include "core/app/report/recorded_snapshots.h"

#include <stdexcept>

#include "core/kernel/mesh/file.h"

namespace drape {

Positions Snapshots::positions(std::size_t snapshot, Eigen::Index n) const {
  using Floats = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
  const auto* first = reinterpret_cast<const float*>(bytes.data()) + snapshot * 3 * n;
  return Eigen::Map<const Floats>(first, n, 3).cast<double>();
}

Snapshots recorded_snapshots(const std::filesystem::path& folder, const nlohmann::ordered_json& level,
                             Eigen::Index n) {
  if (!level.contains("snapshots") || !level["snapshots"].is_object()) return {};
  const nlohmann::ordered_json& entry = level["snapshots"];
  const std::filesystem::path file = folder / entry.at("file").get<std::string>();
  Snapshots snapshots{read_file(file), entry.at("iterations"), entry.at("seconds")};
  snapshots.count = snapshots.iterations.size();
  if (snapshots.seconds.size() != snapshots.count || snapshots.bytes.size() != snapshots.count * n * 12)
    throw std::runtime_error(file.string() + ": holds " + std::to_string(snapshots.bytes.size()) +
                             " bytes, not " + std::to_string(snapshots.count) + " snapshots of " +
                             std::to_string(n) + " vertices");
  return snapshots;
}

std::vector<Positions> snapshot_positions(const RunData& run, const MethodRecord& method,
                                          const LevelRecord& level, Eigen::Index n, std::size_t least) {
  const auto results = nlohmann::ordered_json::parse(read_file(run.folder / "results.json"));
  const nlohmann::ordered_json& entry =
      results.at("methods").at(method.name).at("levels").at(&level - method.levels.data());
  const Snapshots snapshots = recorded_snapshots(run.folder, entry, n);
  if (snapshots.count < least)
    throw std::runtime_error("--frames: the run has no snapshots of level " + std::to_string(level.level) +
                             "; run the experiment with snapshots: 8");
  std::vector<Positions> all;
  for (std::size_t k = 0; k < snapshots.count; ++k) all.push_back(snapshots.positions(k, n));
  return all;
}

}  // namespace drape
