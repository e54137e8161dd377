#include "tests/support/folders.h"

namespace folders {

std::string source() { return DRAPE_SOURCE_DIR; }
std::string commands() { return DRAPE_BUILD_BIN_DIR; }
std::string plugins() { return DRAPE_BUILD_PLUGIN_DIR; }
std::string test_plugins() { return DRAPE_TEST_PLUGIN_DIR; }
std::string example_plugins() { return DRAPE_EXAMPLE_PLUGIN_DIR; }
std::string tests() { return DRAPE_BUILD_TEST_DIR; }

}  // namespace folders
