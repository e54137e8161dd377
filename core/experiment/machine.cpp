#include "core/experiment/machine.h"

#include <fstream>
#include <thread>

namespace drape {

namespace {

/// The rest of the first line of a /proc file that starts with `key`.
std::string proc_value(const char* file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.rfind(key, 0) == 0) {
      const std::size_t at = line.find_first_not_of(" \t:", key.size());
      return at == std::string::npos ? "" : line.substr(at);
    }
  return "";
}

}  // namespace

std::string cpu_name() {
  const std::string name = proc_value("/proc/cpuinfo", "model name");
  return name.empty() ? "unknown" : name;
}

int core_count() { return static_cast<int>(std::thread::hardware_concurrency()); }

void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << 5; }

std::int64_t peak_memory_bytes() {
  const std::string kilobytes = proc_value("/proc/self/status", "VmHWM");
  return kilobytes.empty() ? 0 : 1024 * std::stoll(kilobytes);
}

}  // namespace drape
