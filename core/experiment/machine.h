#pragma once

#include <cstdint>
#include <string>

namespace drape {

std::string cpu_name();  ///< as the kernel gives it, "unknown" where it does not
int core_count();
/// Starts a new measurement of the process's largest resident memory, where the kernel allows it.
void reset_peak_memory();
/// Largest resident memory since then [bytes]; 0 where the kernel does not tell.
std::int64_t peak_memory_bytes();

}  // namespace drape
