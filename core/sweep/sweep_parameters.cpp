#include "core/plugin/bounds.h"
#include "core/plugin/describe.h"
#include "core/sweep/sweep.h"

namespace drape {

void Expectation::declare(Declaration<Expectation>& d) {
  d.add("outcome", &Expectation::outcome)
      .choices({"converged", "converged_to_rounding", "infeasible", "stalled", "out_of_steps", "refused"})
      .description("of every method's worst level; refused: before anything was computed");
  d.add("message", &Expectation::message)
      .description("a part of what it says then; required where it is not to converge");
}

void VariationParameters::declare(Declaration<VariationParameters>& d) {
  d.add("name", &VariationParameters::name).required().description("names its runs, and their folder");
  d.add_node("set", &VariationParameters::set)
      .description(
          "a map: a path of keys in the experiment (methods.pcs.hessian, energies.0), then its value");
  d.add("levels", &VariationParameters::levels)
      .at_least(1)
      .at_most(10)
      .description("in place of the experiment's");
  d.add("methods", &VariationParameters::methods)
      .description("which methods to run; those of the sweep if not given");
  d.add_section("expect", &VariationParameters::expect)
      .description("how its runs are to end; `drape table` and the exit code say whether they did");
}

void SweepParameters::declare(Declaration<SweepParameters>& d) {
  d.add("name", &SweepParameters::name).required().description("names the sweep's folder");
  d.add("description", &SweepParameters::description).description("one sentence");
  d.add("base", &SweepParameters::base)
      .path()
      .description("the experiment that is varied, relative to this file; required without experiments");
  d.add("experiments", &SweepParameters::experiments)
      .description(
          "several that are varied alike, in place of base; * in a file's name stands for anything, in the "
          "order of the alphabet");
  d.add_node("set", &SweepParameters::set)
      .description("a map: a path of keys in the experiment, then its value, for every variation");
  d.add("seeds", &SweepParameters::seeds)
      .at_least(0)
      .at_most(bounds::largest_int)
      .description(
          "every variation is run with each of these as start.seed; the experiment's alone if not given");
  d.add("repeats", &SweepParameters::repeats)
      .at_least(1)
      .at_most(10000)
      .description("short for the seeds 1, 2, … up to this");
  d.add("methods", &SweepParameters::methods)
      .description("which of the experiment's methods to run; all if not given");
  d.add("threads", &SweepParameters::threads).at_least(1).at_most(1024).description("of each run");
  d.add("time_limit", &SweepParameters::time_limit)
      .unit("s")
      .above(0)
      .at_most(1e9)
      .description("a run that takes longer is ended, and has failed; none if not given");
  d.add_node("ablation", &SweepParameters::ablation)
      .description(
          "a list of variations, or {grid: {path: [values], …}}: every combination; the experiments as they "
          "are if not "
          "given");
}

std::string describe_sweep() {
  return describe(schema_of<SweepParameters>()) + "\na variation in ablation:\n\n" +
         describe(schema_of<VariationParameters>());
}

std::string describe_sweep_markdown() {
  return describe_markdown(schema_of<SweepParameters>()) + "\nA variation in `ablation`:\n\n" +
         describe_markdown(schema_of<VariationParameters>());
}

nlohmann::ordered_json sweep_json_schema() {
  using Json = nlohmann::ordered_json;
  Json schema = json_schema(schema_of<SweepParameters>());
  const Json values = {{"type", "array"}, {"minItems", 1}};
  const Json grid = {{"type", "object"}, {"minProperties", 1}, {"additionalProperties", values}};
  schema["properties"]["ablation"]["anyOf"] = Json::array(
      {Json{{"type", "array"}, {"minItems", 1}, {"items", json_schema(schema_of<VariationParameters>())}},
       Json{{"type", "object"},
            {"properties", {{"grid", grid}}},
            {"required", {"grid"}},
            {"additionalProperties", false}}});
  return schema;
}

}  // namespace drape
