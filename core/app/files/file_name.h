#pragma once

#include <filesystem>
#include <string>

namespace drape {

/// Why file names cannot begin with this name, as in "has 300 bytes, and may have 200"; "" if they can.
/// Checked before a run rather than left to the file system in its middle.
std::string fault_of_file_name(const std::string& name);

/// Throws std::runtime_error if a file cannot be written there, is there already and not to be replaced, or
/// would first be written over another one.
void refuse_target(const std::filesystem::path& file, bool overwrite);

}  // namespace drape
