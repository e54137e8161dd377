#include "core/app/report/recorded_snapshots.h"

#include <optional>
#include <stdexcept>

#include "core/app/files/json_file.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/string_utils.h"

namespace drape {

namespace {

/// The levels of a method with at least so many snapshots, as "--level 0".
std::vector<std::string> levels_with_snapshots(const nlohmann::ordered_json& results,
                                               const MethodRecord& method, std::size_t least) {
  std::vector<std::string> options;
  for (std::size_t k = 0; k < method.levels.size(); ++k) {
    const nlohmann::ordered_json& entry = results.at("methods").at(method.name).at("levels").at(k);
    if (entry.contains("snapshots") && entry["snapshots"].is_object() &&
        entry["snapshots"].at("iterations").size() >= least)
      options.push_back("--level " + std::to_string(method.levels[k].level));
  }
  return options;
}

/// Why a level has fewer snapshots than an animation needs, with a remedy.
std::string fault_of_snapshots(const nlohmann::ordered_json& results, const MethodRecord& method,
                               const LevelRecord& level, std::size_t count, std::size_t least) {
  const std::string name = "level " + std::to_string(level.level);
  if (count == 0) return "the run has no snapshots of " + name + "; run the experiment with snapshots: 8";
  if (level.iterations && *level.iterations > 1)
    return "the run has only the last state of " + name + "; run the experiment with snapshots: 8";
  const std::vector<std::string> others = levels_with_snapshots(results, method, least);
  return name + " of " + method.name +
         " took no more than one iteration, so it has no state before its last; " +
         (others.empty() ? "export it without --frames" : "choose " + joined(others));
}

}  // namespace

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
    throw std::runtime_error("--frames: " +
                             fault_of_snapshots(results, method, level, states.count(), least));
  std::vector<Positions> all;
  for (std::size_t k = 0; k < states.count(); ++k) all.push_back(states.positions(k));
  return all;
}

}  // namespace drape
