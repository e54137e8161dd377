// What --set changes of an experiment: a line of the input each.

#include <cstdint>
#include <sstream>

#include "core/app/cli/config_arguments.h"
#include "core/app/experiment/experiment_path.h"
#include "tests/fuzz/experiment_input.h"

namespace {

const char* const experiment = R"(
name: fuzz
levels: 2
pins: [{region: ball, point: [0, 0, 0], radius: 0.1}]
energies: [neo_hookean, hinge, {type: strain_limit, limit: 1.1}, gravity]
contact: [ipc, shapes]
obstacles: [{name: box, meshed_shape: box}, {name: ball, shape: sphere}]
methods: {pcs: {}, slow: {type: newton, newton: {step_size: 0.01}}}
metrics: [energy]
reference: pcs
)";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace drape;
  static const ConfigNode base = [] {
    ConfigErrors errors;
    return parse_yaml(experiment, "base.yaml", errors);
  }();
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (builds_meshes(text)) return 0;
  ConfigArguments arguments;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) arguments.sets.push_back(line);
  Overrides overrides;
  try {
    overrides = arguments.overrides();
  } catch (const std::runtime_error&) {
    return 0;
  }
  ConfigNode source = base;
  ConfigErrors errors;
  for (const auto& [key, value, option] : overrides) {
    const std::size_t before = errors.size();
    require(set_parameter(source, key, value, option, errors) == (errors.size() == before),
            "set, or an error");
  }
  read_twice(std::move(source), std::move(errors));
  return 0;
}
