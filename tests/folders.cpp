#include "tests/support/folders.h"

namespace folders {

std::string source() { return DRAPE_SOURCE_DIR; }
std::string commands() { return DRAPE_BUILD_DIR "/bin"; }
std::string plugins() { return DRAPE_BUILD_DIR "/lib/drape"; }
std::string test_plugins() { return DRAPE_BUILD_DIR "/tests/plugins"; }
std::string example_plugins() { return DRAPE_BUILD_DIR "/tests/examples"; }
std::string tests() { return DRAPE_BUILD_DIR "/tests"; }

}  // namespace folders
