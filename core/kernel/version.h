#pragma once

#include <string>

namespace drape {

/// This library's version, "major.minor.patch".
std::string version();

/// The commit it was built from, as `git describe` names it ("-dirty" when files had changed), or
/// "unknown" where the sources are not a git tree.
std::string commit();

}  // namespace drape
