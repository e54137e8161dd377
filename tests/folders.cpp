#include "tests/support/folders.h"

namespace folders {

std::filesystem::path source() { return DRAPE_SOURCE_DIR; }
std::filesystem::path commands() { return DRAPE_BUILD_DIR "/bin"; }
std::filesystem::path plugins() { return DRAPE_BUILD_DIR "/lib/drape"; }
std::filesystem::path test_plugins() { return DRAPE_BUILD_DIR "/tests/plugins"; }
std::filesystem::path example_plugins() { return DRAPE_BUILD_DIR "/tests/examples"; }

}  // namespace folders
