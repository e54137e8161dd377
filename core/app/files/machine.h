#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/kernel/threads/stopwatch.h"

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
/// The system's mean number of running tasks over the last minute; 0 if unknown.
double load_average();
int processor_count();  ///< of the machine, also where this process may use only some

/// What a stretch of the program took.
struct Work {
  double seconds, cpu_seconds;
};

/// Wall and processor time since construction [s], the latter of all threads of the process.
class WorkClock {
 public:
  double seconds() const { return wall_.seconds(); }
  double cpu_seconds() const { return cpu_time() - cpu_; }
  Work work() const { return {seconds(), cpu_seconds()}; }

 private:
  static double cpu_time();
  Stopwatch wall_;
  double cpu_ = cpu_time();
};

/// Resets the process's peak resident memory, if the kernel supports it.
void reset_peak_memory();
/// Peak resident memory since the last reset [bytes]; 0 if unknown.
std::int64_t peak_memory_bytes();

}  // namespace drape
