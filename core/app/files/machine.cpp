#include "core/app/files/machine.h"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>

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

constexpr double unknown_memory = 1e18;

/// An entry of /proc/meminfo [bytes].
double memory_of(const std::string& key) {
  const std::string kilobytes = proc_value("/proc/meminfo", key);
  return kilobytes.empty() ? unknown_memory : 1024 * std::stod(kilobytes);
}

}  // namespace

std::string cpu_name() {
  const std::string name = proc_value("/proc/cpuinfo", "model name");
  return name.empty() ? "unknown" : name;
}

double machine_memory() {
  double bytes = memory_of("MemTotal");
  double container = 0;
  if (std::ifstream("/sys/fs/cgroup/memory.max") >> container) bytes = std::min(bytes, container);
  rlimit shell{};
  if (getrlimit(RLIMIT_AS, &shell) == 0 && shell.rlim_cur != RLIM_INFINITY)
    bytes = std::min(bytes, static_cast<double>(shell.rlim_cur));
  return bytes;
}

double available_memory() { return memory_of("MemAvailable"); }

void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << 5; }

std::int64_t peak_memory_bytes() {
  const std::string kilobytes = proc_value("/proc/self/status", "VmHWM");
  return kilobytes.empty() ? 0 : 1024 * std::stoll(kilobytes);
}

}  // namespace drape
