#pragma once

#include <filesystem>

/// Folders of the sources and of the build. Functions, and not macros of the command line: so the tests are
/// compiled alike in every folder, and a compiler cache serves all of them.
namespace folders {
std::filesystem::path source();
std::filesystem::path commands();         ///< of drape and its companions
std::filesystem::path plugins();          ///< that drape is shipped with
std::filesystem::path test_plugins();     ///< a folder for each plugin of tests/plugins
std::filesystem::path example_plugins();  ///< of the documents (examples/)
}  // namespace folders
