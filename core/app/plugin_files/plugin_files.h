#pragma once

#include <filesystem>
#include <iosfwd>

namespace drape {

/// The library of a plugin's source, one C++ file, compiled unless it was before: the only file of its
/// folder, which is in $XDG_CACHE_HOME/drape or ~/.cache/drape. `said` receives how long that took, and what
/// the compiler says. Throws std::runtime_error for a file that does not compile.
std::filesystem::path compiled_plugin(const std::filesystem::path& source, std::ostream& said);

}  // namespace drape
