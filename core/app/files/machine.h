#pragma once

#include <cstdint>
#include <string>

namespace drape {

std::string cpu_name();  ///< from the kernel, or "unknown"
/// Memory that this process may use [bytes]: the machine's, limited by container and shell (`ulimit -v`). A
/// very large number if unknown.
double machine_memory();
/// Memory available now without swapping [bytes]; a very large number if unknown.
double available_memory();
/// Resets the process's peak resident memory, if the kernel supports it.
void reset_peak_memory();
/// Peak resident memory since the last reset [bytes]; 0 if unknown.
std::int64_t peak_memory_bytes();

}  // namespace drape
