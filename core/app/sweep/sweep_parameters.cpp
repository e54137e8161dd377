#include "core/app/experiment/describe.h"
#include "core/app/sweep/variations.h"
#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/parameters.h"
#include "core/kernel/threads/parallel.h"

namespace drape {

void Expectation::declare(Declaration<Expectation>& d) {
  d.add("status", &Expectation::status,
        "expected status of every method's worst level; refused: before any computation")
      .choices({"converged", "converged_to_rounding", "infeasible", "stalled", "saddle", "max_steps_reached",
                "refused"});
  d.add("message", &Expectation::message,
        "expected part of the message; required unless the status is converged");
}

void Variation::declare(Declaration<Variation>& d) {
  d.add("name", &Variation::name, "name of the variation and of its runs' folder").required();
  d.add("set", &Variation::set,
        "map from paths of keys in the experiment (methods.pcs.hessian, energies.0) to values");
  d.add("levels", &Variation::levels, "number of levels, in place of the experiment's").between(1, 10);
  d.add("methods", &Variation::methods, "methods to run; by default those of the sweep");
  d.add_section("expect", &Variation::expect,
                "expected status of its runs, checked by `drape table` and the exit code");
}

void SweepParameters::declare(Declaration<SweepParameters>& d) {
  d.add("name", &SweepParameters::name, "name of the sweep and of its folder").required();
  d.add("description", &SweepParameters::description, "one sentence");
  d.add("base", &SweepParameters::base,
        "experiment to vary, relative to this file; required without `experiments`")
      .path();
  d.add("experiments", &SweepParameters::experiments,
        "several experiments to vary alike, in place of `base`; * in a file name matches anything, in "
        "alphabetical order");
  d.add("set", &SweepParameters::set,
        "map from paths of keys in the experiment to values, for every variation");
  d.add("seeds", &SweepParameters::seeds,
        "every variation is run with each of these as start.seed; the experiment's alone if not given")
      .between(0, bounds::largest_int);
  d.add("repeats", &SweepParameters::repeats, "shorthand for seeds 1, 2, … up to this").between(1, 10000);
  d.add("methods", &SweepParameters::methods, "methods of the experiment to run; all by default");
  d.add("threads", &SweepParameters::threads, "threads of each run").between(1, most_threads);
  d.add("time_limit", &SweepParameters::time_limit,
        "a run that takes longer is stopped and counts as failed; no limit by default")
      .unit("s")
      .above(0)
      .at_most(1e9);
  d.add("ablation", &SweepParameters::ablation,
        "list of variations, or {grid: {path: [values], …}} for every combination; by default the unchanged "
        "experiments");
}

std::string describe_sweep() {
  return describe(schema_of<SweepParameters>()) + "\na variation in ablation:\n\n" +
         describe(schema_of<Variation>());
}

std::string describe_sweep_markdown() {
  return describe_markdown(schema_of<SweepParameters>()) + "\nA variation in `ablation`:\n\n" +
         describe_markdown(schema_of<Variation>());
}

Json sweep_json_schema() {
  Json schema = json_schema(schema_of<SweepParameters>());
  const Json values = {{"type", "array"}, {"minItems", 1}};
  const Json grid = {{"type", "object"}, {"minProperties", 1}, {"additionalProperties", values}};
  schema["properties"]["ablation"]["anyOf"] =
      Json::array({Json{{"type", "array"}, {"minItems", 1}, {"items", json_schema(schema_of<Variation>())}},
                   Json{{"type", "object"},
                        {"properties", {{"grid", grid}}},
                        {"required", {"grid"}},
                        {"additionalProperties", false}}});
  return schema;
}

}  // namespace drape
