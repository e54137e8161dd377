#pragma once

#include <cstdint>
#include <string>

namespace drape {

std::string cpu_name();  ///< as the kernel gives it, "unknown" where it does not
int core_count();
/// Memory that this process may come to have [bytes]: the machine's, or what a container's or the shell's
/// limit
/// (`ulimit -v`) leaves of it. A very large number where the kernel does not tell.
double machine_memory();
/// Memory that could be had now without swapping [bytes]; likewise.
double available_memory();
/// Starts a new measurement of the process's largest resident memory, where the kernel allows it.
void reset_peak_memory();
/// Largest resident memory since then [bytes]; 0 where the kernel does not tell.
std::int64_t peak_memory_bytes();

}  // namespace drape
