// Which methods `drape run` runs.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/command.h"

using Catch::Contains;

namespace {

/// The methods in the results of a run, in order; the run is short and need not converge.
std::string methods_of(const std::string& methods, const std::string& options) {
  const Scratch folder(replaced(small_experiment(),
                                "methods:\n  pcs: {}\n  cascadic: {}\n  newton: {}\n"
                                "reference: newton\n",
                                "methods: " + methods + "\n"));
  const Ended ended = drape_with(
      "run e.yaml --out out --levels 1 --set newton.max_steps=1 --no-report " + options, folder.path);
  if (ended.exit_code == 2) {
    CHECK_FALSE(std::filesystem::exists(folder / "out"));
    return ended.err;
  }
  CHECK(ended.exit_code == 1);
  std::string names;
  const auto results = nlohmann::ordered_json::parse(text_of(folder / "out/results.json"));
  for (const auto& [name, method] : results.at("methods").items()) names += name + " ";
  const std::size_t note = ended.err.find("only pcs was run");
  return names + (note == std::string::npos ? "" : ended.err.substr(note));
}

const std::string three = "{cascadic: {}, pcs: {}, newton: {}}";

}  // namespace

TEST_CASE("pcs runs unless methods are named, and the user learns of the others") {
  CHECK(methods_of(three, "") == "pcs only pcs was run; --method all adds cascadic, newton\n");
  CHECK(methods_of(three, "--quiet") == "pcs ");
  CHECK(methods_of(three, "--method newton,cascadic") == "cascadic newton ");  // in the experiment's order
  CHECK(methods_of(three, "--method all") == "cascadic pcs newton ");
}

TEST_CASE("an experiment's only method runs; of several without pcs some must be named") {
  CHECK(methods_of("{newton: {}}", "") == "newton ");
  CHECK(methods_of("{direct: {type: newton}, cascadic: {}}", "") ==
        "error: the experiment has no method pcs, which runs by default; name some of direct, cascadic with "
        "--method, or run them all with --method all\n");
  CHECK(methods_of("{direct: {type: newton}, cascadic: {}}", "--method all") == "direct cascadic ");
  CHECK_THAT(methods_of("{all: {type: pcs}}", ""),
             Contains("\"all\" cannot name a method, since --method all runs every one; rename it"));
}

TEST_CASE("a run of several methods ends with a table of their costs and errors") {
  const Scratch folder(small_experiment());
  const std::string run = "run e.yaml --no-report --overwrite -j 1 -o out ";
  const std::string said = drape_with(run + "--method pcs,newton", folder.path).err;
  const std::size_t table =
      said.find("\nmethod  status     preview_seconds  preview_rms  seconds  error_rms  ");
  REQUIRE(table != std::string::npos);
  CHECK_THAT(said.substr(table), Contains("\npcs     converged  ") && Contains("\nnewton  converged  "));
  CHECK_THAT(drape_with(run, folder.path).err, !Contains("preview_rms"));
}

TEST_CASE("-v shows every iteration, -q nothing, and both exclude each other") {
  const Scratch folder(small_experiment());
  const std::string run =
      "run e.yaml --levels 1 --set newton.max_steps=2 --no-report --overwrite -j 1 -o out ";
  CHECK_THAT(drape_with(run + "-v", folder.path).err,
             Contains("pcs level 0/0 step 0 iteration 0  residual ") && Contains("step size "));
  CHECK(drape_with(run + "-q", folder.path).err == "");
  CHECK_THAT(refused_by(run + "-q -v", folder.path), Contains(" excludes --"));
}
