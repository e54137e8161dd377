#include "core/app/report/run_data.h"

#include <catch2/catch.hpp>

#include "tests/support/command.h"
#include "tests/support/refusal.h"

using namespace drape;

namespace {

/// What reading a run says whose results.json is this.
std::string said_of(const std::string& results) {
  const Scratch folder;
  folder.write("results.json", results);
  const std::string prefix = folder.path.string() + "/", text = refusal_of([&] { read_run(folder.path); });
  return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
}

std::string said_of_level(const std::string& level) {
  return said_of(R"({"methods": {"pcs": {"levels": [{"level": )" + level + "}]}}}");
}

}  // namespace

TEST_CASE("results without methods, or that are cut short, are refused") {
  const std::string again = "; run the experiment again";
  CHECK(said_of("{") == "results.json: is damaged or cut short: it is not a JSON object" + again);
  CHECK(said_of("{}") == "results.json: is damaged: \"methods\" is not a map" + again);
  CHECK(said_of(R"({"methods": [1]})") == "results.json: is damaged: \"methods\" is not a map" + again);
  CHECK(said_of(R"({"methods": {}, "complete": "yes"})") ==
        "results.json: \"complete\" must be true or false, not \"yes\"" + again);
  CHECK(said_of(R"({"methods": {}})") == "");
}

TEST_CASE("a level that is no whole number is named with its file and its key") {
  const std::string must = "results.json: \"level\" must be a whole number, not ",
                    end = "; run the experiment again";
  for (const std::string wrong : {"1e+300", "-1", "0.5", "2147483648", "\"finest\""})
    CHECK(said_of_level(wrong) == must + wrong + end);
  for (const std::string right : {"2147483647", "null"}) CHECK(said_of_level(right) == "");
  CHECK(said_of(R"({"methods": {"pcs": {"consistency": [{"coarse": 0, "fine": 1e10}]}}})") ==
        "results.json: \"fine\" must be a whole number, not 10000000000.0" + end);
}

TEST_CASE("values within objects have their path as name") {
  const Scratch folder;
  folder.write(
      "results.json",
      R"({"methods": {"pcs": {"levels": [{"height": {"lowest": 0.25, "highest": null, "at 0.5": 3}}]}}})");
  const RunData run = read_run(folder.path);
  const Values& values = run.methods[0].levels[0].values;
  CHECK(values.of("height.lowest") == 0.25);
  CHECK(values.of("height.at 0.5") == 3);
  for (const char* none : {"height.highest", "height", "lowest", "height.lowest.0"}) CHECK(!values.of(none));
}

TEST_CASE("results nested a million deep end no process") {
  CHECK(said_of_level("0, \"snapshots\": " + std::string(1000000, '[') + std::string(1000000, ']')) == "");
}
