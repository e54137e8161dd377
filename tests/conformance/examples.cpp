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

TEST_CASE("The documents' examples are among the plugins of the conformance tests") {
  REQUIRE(with_examples);
  using Entry = std::pair<const char*, const char*>;
  for (const auto& [kind, name] :
       {Entry("energy", "orthotropic"), Entry("energy", "springs"), Entry("energy", "spring_to_plane"),
        Entry("refiner", "smooth_midpoint"), Entry("contact", "floor"), Entry("solver", "finest_only"),
        Entry("metric", "height")}) {
    INFO(name);
    CHECK(test_registry().find(kind, name));
  }
}
