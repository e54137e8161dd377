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

}  // namespace drape
