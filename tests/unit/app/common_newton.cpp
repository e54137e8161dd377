// The experiment's `newton`, which is read once and gives the methods their defaults.

#include <catch2/catch.hpp>

#include "core/app/files/yaml_file.h"
#include "tests/support/command.h"
#include "tests/support/refusal.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

const std::string methods = R"(name: e
energies: [gravity]
methods:
  plain: newton
  empty: {type: newton, newton: ~}
  own: {type: newton, newton: {step_size: 0.2, psd_blend: full}}
)";

/// A method's value, which its resolved section has only where it differs from the experiment's.
std::string value(const Experiment& e, const std::string& method, const std::string& key) {
  const ConfigNode* own = e.resolved.find("methods")->find(method)->find("newton");
  const ConfigNode* value = own ? own->find(key) : nullptr;
  return (value ? value : e.resolved.find("newton")->find(key))->scalar;
}

}  // namespace

TEST_CASE("Every method has the experiment's newton, but for what it sets itself") {
  const Experiment e = experiment_from(methods + "newton: {step_size: 0.5, max_steps: 70}\n");
  for (const char* method : {"plain", "empty"}) {
    INFO(method);
    CHECK(value(e, method, "step_size") == "0.5");
    CHECK(value(e, method, "max_steps") == "70");
    CHECK(value(e, method, "psd_blend") == "adaptive");
  }
  CHECK(value(e, "own", "step_size") == "0.2");
  CHECK(value(e, "own", "max_steps") == "70");
  CHECK(value(e, "own", "psd_blend") == "full");
}

TEST_CASE("What a saved experiment's newton is changed to is every method's that shares it") {
  const Experiment e = experiment_from(methods + "newton: {step_size: 0.5}\n");
  CHECK(e.resolved.find("methods")->one_line() ==
        "{plain: {type: newton}, empty: {type: newton}, own: {type: newton, newton: {step_size: 0.2, "
        "psd_blend: full}}}");
  const std::string saved = to_yaml(e.resolved);
  const Experiment again = experiment_from(replaced(saved, "step_size: 0.5", "step_size: 0.25"));
  for (const char* method : {"plain", "empty"}) CHECK(value(again, method, "step_size") == "0.25");
  CHECK(value(again, "own", "step_size") == "0.2");
  CHECK(to_yaml(experiment_from(saved).resolved) == saved);
}

TEST_CASE("A fault of the experiment's newton is told once, not by every method") {
  const std::string said =
      refusal_of([] { experiment_from(methods + "newton: {step_size: 0, max_step: 7}\n"); });
  CHECK_THAT(said, Catch::Contains(":7:21: \"step_size\" must be at least 1.0e-08 s, not 0\n"));
  CHECK_THAT(said, Catch::EndsWith(":7:24: unknown key \"max_step\" in newton; did you mean \"max_steps\"?"));
  CHECK(std::count(said.begin(), said.end(), '\n') == 1);
}
