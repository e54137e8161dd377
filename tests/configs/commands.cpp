// Every subcommand but `run`, `export` and `compare`, which other files here are about.

#include "core/app/experiment/exit_codes.h"
#include "core/app/experiment/experiment.h"
#include "tests/configs/runs.h"
#include "tests/support/registry.h"

using Catch::Matches;

namespace {

std::string shown_by(const std::string& arguments) { return ::shown_by(arguments, folders::source()); }

std::string refusal_of(const std::string& arguments) { return refused_by(arguments, folders::source()); }

/// A folder with the results of a short run, in `out`.
struct ShortRun : Scratch {
  ShortRun() : Scratch(small_experiment()) { run_into("out", *this, "--levels 1 --method newton"); }
};

}  // namespace

TEST_CASE("the bare command shows its usage") {
  CHECK(refusal_of("") == shown_by("--help"));
  CHECK(shown_by("help") == shown_by("--help"));
  CHECK_THAT(shown_by("--help"),
             StartsWith("drape: progressive cloth quasistatics\nUsage: drape [OPTIONS] "));
  CHECK_THAT(shown_by("--version"), Matches("drape [0-9]+\\.[0-9]+\\.[0-9]+ \\(.+\\)\n"));
}

TEST_CASE("help shows a command's options and an example; developers' commands are listed apart") {
  const std::string all = shown_by("help"), heading = "\nFor developers of drape:\n  reference ";
  CHECK(all.find("\n  help ") < all.find(heading));
  CHECK(all.find(heading) < all.find("\n  reference "));
  const auto check_codes = [](const std::string& page) {
    for (const drape::ExitCode& code : drape::exit_codes) CHECK_THAT(page, Contains(code.description));
  };
  check_codes(all);
  for (const std::string command :
       {"new", "check", "check-energy", "run", "view", "export", "figures", "report", "compare", "table",
        "sweep", "list", "describe", "schema", "help", "reference"}) {
    INFO(command);
    const std::string page = shown_by("help " + command);
    CHECK(page == shown_by(command + " --help"));
    CHECK_THAT(page, Contains("\nExample:\n  drape " + command + " "));
    check_codes(page);
  }
}

TEST_CASE("check-energy compares derivatives with differences, and finds an energy or a force that jumps") {
  CHECK_THAT(shown_by("check-energy '{type: pressure, pressure: 20}'"),
             StartsWith("gradient: largest error ") && Contains("\nhessian: largest error ") &&
                 EndsWith("\nderivatives agree with finite differences\n"));
  const auto check = [](const std::string& term) {
    return drape_with("check-energy \"{type: formula, density: '100*(g11^2+g22^2+2*g12^2) + " + term + "'}\"",
                      folders::source());
  };
  const std::string at = ", at strains g11 = ",
                    symmetric = "a smooth function that is symmetric in s1 and s2";
  const std::tuple<std::string, std::string, std::string> jumps[] = {
      {"if(g11 > 0.01, 1, 0)", "the energy", at + "0.01, "},
      {"if(J > 1, 3, 0)", "the energy", at},
      {"5*abs(g11)", "the force", at},
      {"5*max(g22, 0)", "the force", at},
      {"9*max(s1 - 1, 0)^2", "the force", symmetric},
      {"s1 - s2", "the force", symmetric}};
  for (const auto& [term, what, more] : jumps) {
    INFO(term);
    const Ended ended = check(term);
    CHECK(ended.exit_code == 1);
    CHECK_THAT(ended.out, Contains("\nNOT SMOOTH: " + what + " jumps by ") && Contains(more));
  }
  // A law whose stiffness jumps passes.
  for (const char* term : {"9*(s1 - 1)^2 + 9*(s2 - 1)^2", "5*max(g11, 0)^2"})
    CHECK(check(term).exit_code == 0);
  CHECK(drape_with("check-energy '{type: formula, density: \"5\"}'", folders::source()).exit_code == 0);
  CHECK_THAT(check("3000*if(g11 > 0.02, (g11 - 0.02)^1.5, 0)").out, !Contains("NOT SMOOTH"));  // steep
}

TEST_CASE("check finds laws with jumps or with forces at rest, of those that have neither it says nothing") {
  const Scratch folder(small_experiment());
  const std::string law = "100*(g11^2 + g22^2 + g12^2)", jumps = "\nformula: NOT SMOOTH: the force jumps by ",
                    forces = "\nformula: its forces on the rest shape are not zero, but ";
  for (const auto& [density, says] :
       {std::pair(law + " + 100*abs(g11)", jumps), {law + " + 3*g12", forces}, {law, std::string()}}) {
    const std::string said = shown_by(
        "check e.yaml --set 'energies=[{type: formula, density: \"" + density + "\"}, hinge]'", folder.path);
    INFO(said);
    CHECK((said.find(jumps) != said.npos) == (says == jumps));
    CHECK((said.find(forces) != said.npos) == (says == forces));
  }
}

TEST_CASE("check of a sweep says so, and checks every variation") {
  const Scratch folder(small_experiment());
  const std::string sweep =
      "name: s\nbase: e.yaml\nrepeats: 2\nablation:\n  - {name: one}\n  - name: two\n    set: ";
  folder.write("s.yaml", sweep + "{levels: 1}\n");
  CHECK(shown_by("check s.yaml", folder.path) ==
        "s.yaml: valid. A sweep of 4 runs: 2 variations, 2 seeds each. `drape sweep s.yaml` runs it.\n");
  folder.write("s.yaml", sweep + "{start.scale: [0, 0, 1]}\n");
  CHECK_THAT(
      refused(folder, "check s.yaml"),
      StartsWith("error: s.yaml: variation \"two\": energy or forces at the start of level 0 are not "));
  check_error(refused(folder, "check s.yaml --levels 2"), "s.yaml is a sweep: leave out --set, --levels ");
}

TEST_CASE("new writes an experiment that passes check and runs, and overwrites nothing") {
  const Scratch folder;
  CHECK(shown_by("new", folder.path) == "written: first.yaml\nnext: drape run first.yaml\n");
  CHECK_THAT(text_of(folder / "first.yaml"), StartsWith("# ") && Contains("\nname: \"first\"\n"));
  CHECK_THAT(shown_by("check first.yaml", folder.path),
             StartsWith("first.yaml: valid. Vertices by level: 900, "));
  const std::string small = " --levels 1 --set cloth.vertices=256 --set newton.force_tolerance=1e-2";
  shown_by("run first.yaml -q --no-report --measure" + small, folder.path);
  CHECK(fs::exists(folder / "results/first/levels/pcs_l0.ply"));
  check_error(refused(folder, "new first"),  // the extension is added
              "first.yaml: exists already; name another file, as in drape new first_2.yaml\n");
  drape_ends("new null.yml", folder);
  drape_ends("check null.yml", folder);
  CHECK_THAT(refused(folder, "new 'a b.yaml'"), Contains("\"a b\" names files: write it with letters"));
}

TEST_CASE("list and describe show plugins with their parameters, and an experiment's") {
  const std::string all = shown_by("list"), energies = shown_by("list energy");
  for (const auto& entry : test_registry().entries()) {
    INFO(entry->name);
    CHECK_THAT(all, Contains("\n  " + entry->name + " ") && Contains(entry->summary));
  }
  CHECK_THAT(energies, StartsWith("energy\n  constant_load  ") && !Contains("cascadic"));
  CHECK_THAT(all, StartsWith(energies));
  CHECK_THAT(shown_by("describe hinge"), StartsWith("energy hinge: Bending by the angles between "));
  CHECK_THAT(shown_by("describe gravity"), Contains("acceleration") && Contains("[0, 0, -9.81]"));
  CHECK_THAT(shown_by("describe experiment"), Contains("membrane_modulus"));
  CHECK_THAT(shown_by("describe sweep"), Contains("seeds") && Contains("a variation in ablation:"));
}

TEST_CASE("schema is a JSON Schema of experiments, with every plugin's name and parameters, or of sweeps") {
  const auto schema = nlohmann::json::parse(shown_by("schema"));
  CHECK(schema.at("type") == "object");
  CHECK(schema.at("additionalProperties") == false);
  CHECK((schema.at("required") == nlohmann::json{"name", "energies", "methods"}));
  const auto& properties = schema.at("properties");
  const drape::Schema ours = drape::schema_of<drape::ExperimentParameters>();
  CHECK(properties.size() == ours.parameters.size());
  for (const drape::Parameter& p : ours.parameters) CHECK(properties.count(p.name) == 1);
  // Obstacles and friction are keys of the experiment, in whichever contact model they are declared.
  CHECK(properties["obstacles"]["items"]["anyOf"].size() == 2);
  int models = 0;
  for (const auto& choice : properties["contact"]["anyOf"][0]["anyOf"]) {
    if (!choice.contains("properties")) continue;
    ++models;
    CHECK(!choice["properties"].contains("obstacles"));
    CHECK(!choice["properties"].contains("friction"));
  }
  CHECK(models >= 2);

  const auto of_sweeps = nlohmann::json::parse(shown_by("schema sweep"));
  CHECK(of_sweeps["additionalProperties"] == false);
  CHECK((of_sweeps["required"] == nlohmann::json{"name"}));  // and either base or experiments
  const auto& ablation = of_sweeps["properties"]["ablation"]["anyOf"];
  REQUIRE(ablation.size() == 2);
  CHECK((ablation[0]["items"]["required"] == nlohmann::json{"name"}));
  CHECK(ablation[0]["items"]["properties"]["levels"]["anyOf"][0]["maximum"] == 10);
  CHECK(ablation[1]["properties"]["grid"]["additionalProperties"]["minItems"] == 1);
}

TEST_CASE("reference is docs/reference/configuration.md, which is up to date") {
  const std::string page = shown_by("reference");
  CHECK_THAT(page, StartsWith("# Configuration reference\n"));
  for (const auto& entry : test_registry().entries()) CHECK_THAT(page, Contains(entry->name));
  // Newton's parameters once, under their own heading; experiments and methods refer to it.
  const std::string row = "\n|`step_growth`|";
  REQUIRE(page.find(row) != page.npos);
  CHECK(page.find(row) == page.rfind(row));
  CHECK_THAT(page, !Contains("`newton.step_growth`") && Contains("see [Newton](#newton)"));
  CHECK_THAT(page, Contains("\n|`handles[].region`, `point`, ") && Contains("|as of `pins[]`|"));
  INFO("after a change, run: build/bin/drape reference > docs/reference/configuration.md");
  CHECK((text_of(folders::source() / "docs/reference/configuration.md") == page));
}

TEST_CASE("every plugin has a page of its own, which leads to its parameters") {
  for (const auto& entry : test_registry().entries()) {
    const std::string page = "plugins/" + entry->kind + "/" + entry->name + "/README.md";
    INFO(page);
    const std::string link = "docs/reference/configuration.md#" + entry->kind + "-" + entry->name;
    const std::string text = text_of(folders::source() / page);
    CHECK_THAT(text, StartsWith("# " + entry->name + "\n"));
    CHECK((entry->schema.parameters.empty() || text.find(link) != text.npos));
  }
}

TEST_CASE("report rewrites a run's page, or names what is missing") {
  const ShortRun folder;
  REQUIRE(!fs::exists(folder / "out/report.html"));
  CHECK(shown_by("report out", folder.path) == "report: out/report.html\n");
  CHECK(text_of(folder / "out/report.html").ends_with("</html>\n"));
  check_refusals(
      folder, "report ",
      {{"nowhere", "nowhere: neither results.json nor sweep.json here; give the folder of a run or "},
       {"out out --out a.html --width 90", "--width is for the pictures of one run; a page of several "},
       {"out out --out nowhere/a.html", "nowhere: cannot be written to (No such file or directory); "}});
  folder.write("out/pictures/mine.png", "mine");
  fs::remove(folder / "out/levels/newton_l0.ply");
  REQUIRE(fs::exists(folder / "out/pictures/newton_l0.png"));
  CHECK_THAT(drape_ends("report out", folder).err, StartsWith("warning: cannot read out/levels/newton_l0"));
  CHECK_FALSE(fs::exists(folder / "out/pictures/newton_l0.png"));
  CHECK(fs::exists(folder / "out/pictures/mine.png"));
  folder.write("out/results.json", "{\"experiment\": ");
  CHECK_THAT(refused(folder, "report out"), StartsWith("error: out/results.json"));
}

TEST_CASE("a report that cannot be written is refused before anything is drawn, with another place") {
  const ShortRun folder;
  if (Command("unshare -rm true", folder.path).wait().exit_code != 0) {
    WARN("no user namespaces here: a read-only folder is not tried");
    return;
  }
  for (const std::string command : {"report out", "view out"}) {
    const std::string read_only =
        "unshare -rm sh -c 'mount --bind out out && mount -o remount,ro,bind out && exec ";
    const Ended ended = Command(read_only + drape_command + " " + command + "'", folder.path).wait();
    CHECK(ended.exit_code == 2);
    check_error(ended.err, "out: cannot be written to (Read-only file system); copy the folder to where it ");
  }
}

TEST_CASE("a --set takes one value, so that the config may follow it") {
  CHECK_THAT(shown_by("check --set levels=1 --set cloth.rows=7 e.yaml", Scratch(small_experiment()).path),
             StartsWith("e.yaml: valid. Vertices by level: 42\n"));
}
