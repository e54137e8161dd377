#pragma once

#include <filesystem>
#include <string>

namespace drape {

/// Why the file cannot be a shared library that this process may load, and what to do about it; "" if nothing
/// speaks against it. dlopen maps what a library's headers promise without looking whether the file has it,
/// and a file cut short then ends the process with SIGBUS.
std::string fault_of_library(const std::filesystem::path& file);

}  // namespace drape
