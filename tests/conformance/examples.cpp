// The examples of docs/extend/add-a-plugin.md and docs/extend/add-an-energy.md, which the other tests of this
// program do not name, are put through them too.

#include <catch2/catch.hpp>

#include "tests/support/folders.h"
#include "tests/support/registry.h"

namespace {

const bool with_examples = [] {
  test_plugin_folders().emplace_back(folders::example_plugins());
  return true;
}();

}  // namespace

TEST_CASE("The documents' examples are among the plugins of the conformance tests", "[conformance]") {
  REQUIRE(with_examples);
  for (const auto& [kind, name] :
       std::initializer_list<std::pair<const char*, const char*>>{{"energy", "orthotropic"},
                                                                  {"energy", "springs"},
                                                                  {"energy", "spring_to_plane"},
                                                                  {"refiner", "smooth_midpoint"},
                                                                  {"contact", "floor"},
                                                                  {"solver", "finest_only"},
                                                                  {"metric", "height"}}) {
    INFO(name);
    CHECK(test_registry().find(kind, name));
  }
}
