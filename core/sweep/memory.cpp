#include "core/sweep/memory.h"

#include <algorithm>
#include <fstream>

namespace drape {

namespace {

// On the sphere, with contact, runs took 0.1 GB and 13 KB a vertex from 6K to 25K vertices. Twice that much a
// vertex, since factors grow faster than meshes.
constexpr double program = 1e8, a_vertex = 2.6e4;

}  // namespace

double available_memory() {
  std::ifstream in("/proc/meminfo");
  std::string word;
  for (double kilobytes = 0; in >> word;)
    if (word == "MemAvailable:" && in >> kilobytes) return 1024 * kilobytes;
  return 1e18;
}

void MemoryEstimate::learn(const SweepRun& run, const RunFiles& files) {
  const auto results =
      nlohmann::ordered_json::parse(text_of_file(files.folder / "results.json"), nullptr, false);
  if (!results.is_object() || !results.contains("methods")) return;
  double& peak = peaks_[{run.vertices, run.levels}];
  for (const auto& [name, method] : results["methods"].items())
    peak = std::max(peak, method.value("peak_memory_bytes", 0.0));
}

double MemoryEstimate::bytes(const SweepRun& run) const {
  const auto known = peaks_.find({run.vertices, run.levels});
  if (known != peaks_.end() && known->second > 0) return known->second;
  return program + a_vertex * run.vertices;
}

}  // namespace drape
