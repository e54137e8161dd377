#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace drape {

std::string cpu_name();  ///< from the kernel, or "unknown"
/// Memory that this process may use [bytes]: the machine's, limited by container and shell (`ulimit -v`). A
/// very large number if unknown.
double machine_memory();
/// Memory available now without swapping, in this process's container too [bytes]; a very large number if
/// unknown.
double available_memory();

/// What a container allows its processes [bytes]; very large numbers without a limit.
struct ContainerMemory {
  double limit, available;
  /// As the files of a control group, version 2, say in this folder.
  static ContainerMemory of(const std::filesystem::path& group = "/sys/fs/cgroup");
};
/// Resets the process's peak resident memory, if the kernel supports it.
void reset_peak_memory();
/// Peak resident memory since the last reset [bytes]; 0 if unknown.
std::int64_t peak_memory_bytes();

}  // namespace drape
