#include "core/app/files/machine.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <fstream>

namespace drape {

namespace {

/// The rest of the first line of a file that starts with `key`.
std::string value_in(const std::filesystem::path& file, const std::string& key) {
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
  const std::string kilobytes = value_in("/proc/meminfo", key);
  return kilobytes.empty() ? unknown_memory : 1024 * std::stod(kilobytes);
}

}  // namespace

std::string cpu_name() {
  const std::string name = value_in("/proc/cpuinfo", "model name");
  return name.empty() ? "unknown" : name;
}

double machine_memory() {
  double bytes = std::min(memory_of("MemTotal"), ContainerMemory::of().limit);
  rlimit shell{};
  if (getrlimit(RLIMIT_AS, &shell) == 0 && shell.rlim_cur != RLIM_INFINITY)
    bytes = std::min(bytes, static_cast<double>(shell.rlim_cur));
  return bytes;
}

double available_memory() { return std::min(memory_of("MemAvailable"), ContainerMemory::of().available); }

ContainerMemory ContainerMemory::of(const std::filesystem::path& group) {
  double limit = 0, used = 0;
  if (!(std::ifstream(group / "memory.max") >> limit)) return {unknown_memory, unknown_memory};
  if (!(std::ifstream(group / "memory.current") >> used)) return {limit, limit};
  const std::string files =
      value_in(group / "memory.stat", "inactive_file");  // the kernel drops them on demand
  if (!files.empty()) used -= std::min(used, std::stod(files));
  return {limit, std::max(0.0, limit - used)};
}

double load_average() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? load : 0;
}

int processor_count() { return static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)); }

double WorkClock::cpu_time() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << 5; }

std::int64_t peak_memory_bytes() {
  const std::string kilobytes = value_in("/proc/self/status", "VmHWM");
  return kilobytes.empty() ? 0 : 1024 * std::stoll(kilobytes);
}

}  // namespace drape
