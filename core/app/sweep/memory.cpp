#include "core/app/sweep/memory.h"

#include <algorithm>
#include <stdexcept>

#include "core/app/experiment/cloth.h"
#include "core/app/files/json_file.h"

namespace drape {

MemoryEstimate::MemoryEstimate(const Sweep& sweep, const SweepFolder& folder) {
  for (const SweepRun& run : sweep.runs)
    if (const RunFiles files = folder.files(run.folder); read_status(files).has_results()) learn(run, files);
}

void MemoryEstimate::learn(const SweepRun& run, const RunFiles& files) {
  const std::filesystem::path path = files.folder / "results.json";
  const JsonFile file(path, "remove the run's folder, and the sweep runs it again");
  const auto results = parse_json(text_of_file(path));
  if (!results.is_object() || !results.contains("methods")) return;
  double& peak = peaks_[{run.vertices, run.levels}];
  for (const auto& [name, method] : results["methods"].items())
    peak = std::max(peak, file.find<double>(method, "peak_memory_bytes").value_or(0));
}

double MemoryEstimate::bytes(const SweepRun& run) const {
  const auto known = peaks_.find({run.vertices, run.levels});
  if (known != peaks_.end() && known->second > 0) return known->second;
  return estimated_memory(run.vertices);
}

void MemoryEstimate::require(const Sweep& sweep, const SweepFolder& folder, double machine) const {
  for (const SweepRun& run : sweep.runs)
    if (bytes(run) > machine && !read_status(folder.files(run.folder)).has_results())
      throw std::runtime_error(run.name + ", seed " + std::to_string(run.seed) + ", may need " +
                               memory_text(bytes(run)) + " of memory, where this machine has " +
                               memory_text(machine) +
                               "; take fewer levels or vertices, or allow it with --allow-memory");
}

}  // namespace drape
