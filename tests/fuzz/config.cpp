// An experiment file, with the parameters of every plugin that it names.

#include <cstdint>

#include "tests/fuzz/experiment_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace drape;
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (builds_meshes(text)) return 0;
  ConfigErrors errors;
  ConfigNode source = parse_yaml(text, "fuzz.yaml", errors);
  require(errors.empty() == (source.kind == ConfigNode::Kind::map),
          "a map and no errors, or errors and none");
  if (errors.empty()) read_twice(std::move(source), {});
  return 0;
}
