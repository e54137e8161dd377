#pragma once

#include <string>

/// Folders of the sources and of the build, without a slash at the end. Functions, and not macros of the
/// command line: so the tests are compiled alike in every folder, and a compiler cache serves all of them.
namespace folders {
std::string source();
std::string commands();         ///< of drape and its companions
std::string plugins();          ///< that drape is shipped with
std::string test_plugins();     ///< a folder for each plugin of tests/plugins
std::string example_plugins();  ///< of the documents (examples/)
std::string tests();            ///< of the test programs
}  // namespace folders
