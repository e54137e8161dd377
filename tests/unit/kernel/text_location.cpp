#include <catch2/catch.hpp>

#include "core/app/files/yaml_file.h"
#include "core/kernel/plugin/config_node.h"
#include "tests/support/command.h"

using namespace drape;

namespace {

/// "line:column" of the first `$` in the value of the key `text`.
std::string place_of_dollar(const std::string& yaml) {
  const Scratch folder(yaml);
  ConfigErrors errors;
  const ConfigNode config = read_yaml(folder / "e.yaml", errors);
  REQUIRE(errors.empty());
  const ConfigNode& text = *config.find("text");
  const Location where = location_in_text(text, text.scalar.find('$'));
  return std::to_string(where.line) + ":" + std::to_string(where.column);
}

}  // namespace

TEST_CASE("a byte of a text is found in its file, however the text is written") {
  CHECK(place_of_dollar("text: ab + $c\n") == "1:12");
  CHECK(place_of_dollar("text: \"ab + $c\"\n") == "1:13");
  CHECK(place_of_dollar("text: 'ab + $c'\n") == "1:13");
  CHECK(place_of_dollar("other: 1\ntext: \"ab\n   + $c\"\n") == "3:6");
  CHECK(place_of_dollar("text: |\n  ab\n  + $c\n") == "3:5");
  CHECK(place_of_dollar("text: >-\n  ab\n\n  + $c\n") == "4:5");
}

TEST_CASE("a text that its file does not show has its own location") {
  ConfigNode text = ConfigNode::of("ab");
  text.where = {"--set text", 0, 0};
  CHECK(location_in_text(text, 1).text() == "--set text");
  text.where = {"no such file", 2, 3};
  CHECK(location_in_text(text, 1).text() == "no such file:2:3");
}
