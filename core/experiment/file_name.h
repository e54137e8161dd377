#pragma once

#include <string>

namespace drape {

/// Why names of files cannot begin with this, as in "has 300 bytes, and may have 200"; "" if they can. Such a
/// name is found wanting before a run begins, and not by the file system in the middle of it.
std::string fault_of_file_name(const std::string& name);

}  // namespace drape
