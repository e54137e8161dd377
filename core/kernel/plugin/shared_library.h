#pragma once

#include <filesystem>
#include <string>

namespace drape {

/// Why the file is not a loadable shared library, with a remedy; "" if it may be one. The check is needed
/// because dlopen maps segments without checking the file's size: a truncated file ends the process with
/// SIGBUS.
std::string fault_of_library(const std::filesystem::path& file);

}  // namespace drape
