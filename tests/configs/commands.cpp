// Every subcommand but `run` and `check`, which the other files here are about.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/app/experiment/exit_codes.h"
#include "core/app/experiment/experiment.h"
#include "tests/support/command.h"
#include "tests/support/folders.h"
#include "tests/support/registry.h"

namespace fs = std::filesystem;
using Catch::Contains;
using Catch::EndsWith;
using Catch::Matches;
using Catch::StartsWith;

namespace {

std::string shown_by(const std::string& arguments) { return ::shown_by(arguments, folders::source()); }

std::string refusal_of(const std::string& arguments) { return refused_by(arguments, folders::source()); }

}  // namespace

TEST_CASE("the bare command shows its usage; a misspelt command names the nearest one") {
  CHECK(refusal_of("") == shown_by("--help"));
  CHECK_THAT(shown_by("--help"),
             StartsWith("drape: progressive cloth quasistatics\nUsage: drape [OPTIONS] SUBCOMMAND\n"));
  CHECK_THAT(shown_by("run --help"), Contains("--overwrite"));
  CHECK(refusal_of("rnu e.yaml") == "error: there is no command \"rnu\"; did you mean \"run\"?\n");
  CHECK(refusal_of("simulate") ==
        "error: there is no command \"simulate\"; the commands are new, check, check-energy, run, view, "
        "export, figures, fabric, fit, report, compare, table, sweep, list, describe, schema, help, "
        "reference\n");
  CHECK(refusal_of("run") == "error: experiment is required; see `drape run --help`\n");
  CHECK(refusal_of("--fast") == "error: A subcommand is required; see `drape --help`\n");
  CHECK_THAT(shown_by("--version"), Matches("drape [0-9]+\\.[0-9]+\\.[0-9]+ \\(.+\\)\n"));
}

TEST_CASE("help shows a command's options and an example; developers' commands are listed apart") {
  CHECK(shown_by("help") == shown_by("--help"));
  const std::string all = shown_by("help"), heading = "\nFor developers of drape:\n  reference ";
  CHECK(all.find("\n  help ") < all.find(heading));
  CHECK(all.find(heading) < all.find("\n  reference "));
  const auto has_codes = [](const std::string& page) {
    for (const drape::ExitCode& code : drape::exit_codes) CHECK_THAT(page, Contains(code.description));
  };
  has_codes(all);
  for (const std::string command :
       {"new", "check", "check-energy", "run", "view", "export", "figures", "report", "compare", "table",
        "sweep", "list", "describe", "schema", "help", "reference"}) {
    INFO(command);
    const std::string page = shown_by("help " + command);
    CHECK(page == shown_by(command + " --help"));
    CHECK_THAT(page, Contains("\nExample:\n  drape " + command + " "));
    has_codes(page);
  }
  CHECK(refusal_of("help rnu") == "error: there is no command \"rnu\"; did you mean \"run\"?\n");
  CHECK(refusal_of("run e.yaml --methods pcs") ==
        "error: there is no option --methods; did you mean --method? See `drape run --help`\n");
  CHECK(refusal_of("export out --to a.glb --frame") ==
        "error: there is no option --frame; did you mean --frames? See `drape export --help`\n");
}

TEST_CASE("check-energy compares the derivatives of an energy with differences") {
  const std::string agrees = shown_by("check-energy '{type: pressure, pressure: 20}'");
  CHECK_THAT(agrees, StartsWith("gradient: largest error ") && Contains("\nhessian: largest error ") &&
                         EndsWith("\nderivatives agree with finite differences\n"));
  CHECK_THAT(refusal_of("check-energy neo_hokean"),
             StartsWith("error: energy: unknown energy \"neo_hokean\"; did you mean \"neo_hookean\"?"));
}

TEST_CASE("check-energy finds an energy or a force that jumps, and passes a law whose stiffness does") {
  const auto check = [](const std::string& term) {
    return drape_with("check-energy \"{type: formula, density: '100*(g11^2+g22^2+2*g12^2) + " + term + "'}\"",
                      folders::source());
  };
  const auto finds = [&](const std::string& term, const std::string& what, const std::string& more) {
    INFO(term);
    const Ended ended = check(term);
    CHECK(ended.exit_code == 1);
    CHECK_THAT(ended.out, Contains("\nNOT SMOOTH: " + what + " jumps by ") && Contains(more));
  };
  finds("if(g11 > 0.01, 1, 0)", "the energy", ", at strains g11 = 0.01, ");
  finds("if(J > 1, 3, 0)", "the energy", ", at strains g11 = ");
  for (const char* term : {"5*abs(g11)", "5*abs(g12)", "5*max(g22, 0)"})
    finds(term, "the force", ", at strains g11 = ");
  for (const char* term :
       {"9*(s1 - 1)^2 + 5*(s2 - 1)^2", "9*max(s1 - 1, 0)^2", "9*max(1 - s2, 0)^2", "s1 - s2"})
    finds(term, "the force", "let the law be a smooth function that is symmetric in s1 and s2");
  CHECK(check("9*(s1 - 1)^2 + 9*(s2 - 1)^2 + s1*s2").exit_code == 0);
  CHECK(drape_with("check-energy '{type: formula, density: \"5\"}'", folders::source()).exit_code == 0);
  CHECK(check("5*max(g11, 0)^2").exit_code == 0);
  CHECK_THAT(check("3000*if(g11 > 0.02, (g11 - 0.02)^1.5, 0)").out, !Contains("NOT SMOOTH"));  // steep
}

TEST_CASE("check finds laws with jumps or with forces at rest, of those that have neither it says nothing") {
  const Scratch folder(small_experiment());
  const auto lines = [&](const std::string& density) {
    return shown_by("check e.yaml --set 'energies=[{type: formula, density: \"" + density + "\"}, hinge]'",
                    folder.path);
  };
  CHECK_THAT(lines("100*(abs(g11) + g11^2 + g22^2 + g12^2)"),
             Contains("\nformula: NOT SMOOTH: the force jumps by ") && !Contains("forces on the rest"));
  CHECK_THAT(
      lines("100*(g11^2 + g22^2 + g12^2) + 3*g12"),
      Contains("\nformula: its forces on the rest shape are not zero, but ") && !Contains("NOT SMOOTH"));
  CHECK_THAT(lines("100*(g11^2 + g22^2 + g12^2)"),
             !Contains("NOT SMOOTH") && !Contains("forces on the rest"));
}

TEST_CASE("check of a sweep says so, and checks every variation") {
  const Scratch folder(small_experiment());
  const std::string sweep =
      "name: s\nbase: e.yaml\nrepeats: 2\nablation:\n  - {name: one}\n  - name: two\n    set: ";
  folder.write("s.yaml", sweep + "{levels: 1}\n");
  CHECK(shown_by("check s.yaml", folder.path) ==
        "s.yaml: valid. A sweep of 4 runs: 2 variations, 2 seeds each. `drape sweep s.yaml` runs it.\n");
  folder.write("s.yaml", sweep + "{start.scale: [0, 0, 1]}\n");
  const std::string flat = refused_by("check s.yaml", folder.path);
  CHECK_THAT(
      flat,
      StartsWith(
          "error: s.yaml: variation \"two\": energy or forces at the start of level 0 are not finite: "));
  for (const char* command : {"run s.yaml", "fit s.yaml --to 1 --by material.density"})
    CHECK(refused_by(command, folder.path) ==
          "error: s.yaml: is a sweep: `drape sweep` runs it, `drape check` checks it\n");
  CHECK(refused_by("sweep e.yaml", folder.path) == "error: e.yaml: is an experiment: `drape run` runs it\n");
  CHECK_THAT(drape_with("check s.yaml --levels 2", folder.path).err,
             StartsWith("error: s.yaml is a sweep: leave out --set, --levels "));
}

TEST_CASE("new writes an experiment that passes check and runs, and overwrites nothing") {
  const Scratch folder;
  CHECK(shown_by("new", folder.path) == "written: first.yaml\nnext: drape run first.yaml\n");
  const std::string text = text_of(folder / "first.yaml");
  CHECK_THAT(text, StartsWith("# ") && Contains("drape run first.yaml") && Contains("\nname: \"first\"\n"));
  CHECK_THAT(shown_by("check first.yaml", folder.path),
             StartsWith("first.yaml: valid. Vertices by level: 900, 3481, 13689\n"));
  shown_by(
      "run first.yaml --quiet --no-report --levels 1 --set cloth.vertices=256 "
      "--set newton.force_tolerance=1e-2",
      folder.path);
  CHECK(fs::exists(folder / "results/first/levels/pcs_l0.ply"));

  CHECK(refused_by("new first", folder.path) ==  // the extension is added
        "error: first.yaml: exists already; name another file, as in drape new first_2.yaml\n");
  CHECK(text_of(folder / "first.yaml") == text);
  drape_ends("new null.yml", folder);
  drape_ends("check null.yml", folder);
  CHECK_THAT(drape_with("new 'a b.yaml'", folder.path).err,
             Contains("\"a b\" names files: write it with letters"));
  CHECK_FALSE(fs::exists(folder / "a b.yaml"));
}

TEST_CASE("an obstacle that is missing from data/ says how to make it") {
  const Scratch folder;
  fs::create_directory(folder / "configs");
  folder.write("configs/e.yaml", replaced(small_experiment(), "levels: 2\n",
                                          "levels: 2\ncontact: ipc\nobstacles: [{name: bunny, mesh: "
                                          "../data/bunny.ply}]\n"));
  CHECK_THAT(refused_by("check configs/e.yaml", folder.path),
             Contains("bunny.ply: No such file or directory") && EndsWith("; `make data` makes it\n"));
}

TEST_CASE("list shows every plugin, or one kind's") {
  const std::string all = shown_by("list");
  for (const auto& entry : test_registry().entries()) {
    INFO(entry->name);
    CHECK_THAT(all, Contains("\n  " + entry->name + " "));
    CHECK_THAT(all, Contains(entry->summary));
  }
  const std::string energies = shown_by("list energy");
  CHECK_THAT(energies, StartsWith("energy\n  constant_load  "));
  CHECK_THAT(all, StartsWith(energies));
  CHECK(energies.find("cascadic") == std::string::npos);
  CHECK(refusal_of("list nonsense") ==
        "error: there is no kind \"nonsense\"; the kinds are energy, refiner, contact, solver, metric\n");
}

TEST_CASE("describe shows a plugin's parameters, an experiment's, or the nearest name") {
  CHECK_THAT(shown_by("describe hinge"),
             StartsWith("energy hinge: Bending by the angles between triangles, any rest shape.\nfrom /"));
  CHECK_THAT(shown_by("describe gravity"),
             Contains("acceleration") && Contains("[0, 0, -9.81]") && Contains("m/s²"));
  CHECK_THAT(shown_by("describe experiment"), Contains("membrane_modulus"));
  CHECK(refusal_of("describe hinje") == "error: no plugin is called \"hinje\"; did you mean \"hinge\"?\n");
  CHECK(refusal_of("describe butterfly") ==
        "error: no plugin is called \"butterfly\"; `drape list` names them all\n");
}

TEST_CASE("schema is a JSON Schema of experiments, with every plugin's name and parameters") {
  const auto schema = nlohmann::json::parse(shown_by("schema"));
  CHECK(schema.at("type") == "object");
  CHECK(schema.at("additionalProperties") == false);
  CHECK((schema.at("required") == nlohmann::json{"name", "energies", "methods"}));
  const auto& properties = schema.at("properties");
  const drape::Schema ours = drape::schema_of<drape::ExperimentParameters>();
  CHECK(properties.size() == ours.parameters.size());
  for (const drape::Parameter& p : ours.parameters) {
    INFO(p.name);
    REQUIRE(properties.contains(p.name));
  }
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
}

TEST_CASE("schema sweep and describe sweep cover sweep files, variations and grids included") {
  const auto schema = nlohmann::json::parse(shown_by("schema sweep"));
  CHECK(schema["additionalProperties"] == false);
  CHECK((schema["required"] == nlohmann::json{"name"}));  // and either base or experiments
  const auto& ablation = schema["properties"]["ablation"]["anyOf"];
  REQUIRE(ablation.size() == 2);
  CHECK((ablation[0]["items"]["required"] == nlohmann::json{"name"}));
  CHECK(ablation[0]["items"]["properties"]["levels"]["anyOf"][0]["maximum"] == 10);
  CHECK(ablation[1]["properties"]["grid"]["additionalProperties"]["minItems"] == 1);
  CHECK_THAT(shown_by("describe sweep"), Contains("seeds") && Contains("a variation in ablation:"));
  CHECK(refusal_of("schema nonsense") ==
        "error: kind: nonsense not in {experiment,sweep}; see `drape schema --help`\n");
}

TEST_CASE("reference is docs/reference/configuration.md, which is up to date") {
  const std::string page = shown_by("reference");
  CHECK_THAT(page, StartsWith("# Configuration reference\n"));
  for (const auto& entry : test_registry().entries()) CHECK_THAT(page, Contains(entry->name));
  // Newton's parameters once, under their own heading; experiments and methods refer to it.
  const std::string row = "\n| `step_growth` |";
  const std::size_t first = page.find(row);
  REQUIRE(first != page.npos);
  CHECK(page.find(row, first + 1) == page.npos);
  CHECK_THAT(page, !Contains("`newton.step_growth`") && Contains("see [Newton](#newton)"));
  const fs::path stored = folders::source() / "docs/reference/configuration.md";
  INFO("after a change, run: build/bin/drape reference > docs/reference/configuration.md");
  CHECK((text_of(stored) == page));
}

TEST_CASE("every plugin has a page of its own, with its parameters up to date") {
  const Scratch folder;
  const fs::path plugins = folders::source() / "plugins";
  for (const auto& entry : test_registry().entries()) {
    const fs::path name = fs::path(entry->kind) / entry->name / "README.md";
    INFO(name.string());
    REQUIRE(fs::exists(plugins / name));
    fs::create_directories((folder / "pages" / name).parent_path());
    fs::copy_file(plugins / name, folder / "pages" / name);
  }
  folder.write("pages/energy/gravity/README.md", "# gravity\n\n## Parameters\n\nold\n\n## Source\n\nours\n");
  drape_ends("reference --readmes pages", folder);
  const std::string gravity = text_of(folder / "pages/energy/gravity/README.md");
  CHECK_THAT(gravity, Contains("`acceleration`") && EndsWith("|\n\n## Source\n\nours\n") && !Contains("old"));
  INFO("after a change, run: build/bin/drape reference --readmes plugins");
  for (const auto& entry : test_registry().entries()) {
    const fs::path name = fs::path(entry->kind) / entry->name / "README.md";
    INFO(name.string());
    if (entry->name != "gravity") CHECK((text_of(plugins / name) == text_of(folder / "pages" / name)));
  }
  CHECK(refusal_of("reference --readmes nowhere") ==
        "error: --readmes nowhere: no KIND/NAME/README.md of a plugin there; give the folder `plugins`\n");
}

TEST_CASE("report rewrites a run's page, or names what is missing") {
  const Scratch folder(small_experiment());
  drape_ends("run e.yaml --out out --levels 1 --method newton --quiet --no-report", folder);
  REQUIRE(!fs::exists(folder / "out/report.html"));
  CHECK(shown_by("report out", folder.path) == "report: out/report.html\n");
  CHECK(text_of(folder / "out/report.html").ends_with("</html>\n"));
  CHECK(refusal_of("report nowhere") ==
        "error: nowhere: neither results.json nor sweep.json here; give the folder of a run or a sweep\n");
  CHECK_THAT(refusal_of("report out --width 15"), Contains("must be 16 to 8000 pixels, not 15"));
  CHECK(refusal_of("report out out --out both.html --width 90") ==
        "error: --width is for the pictures of one run; a page of several runs has none\n");
  REQUIRE(fs::exists(folder / "out/pictures/newton_l0.png"));
  folder.write("out/pictures/mine.png", "mine");
  fs::remove(folder / "out/levels/newton_l0.ply");
  CHECK(drape_ends("report out", folder).err ==
        "warning: cannot read out/levels/newton_l0.ply: No such file or directory\n");
  CHECK_FALSE(fs::exists(folder / "out/pictures/newton_l0.png"));
  CHECK(fs::exists(folder / "out/pictures/mine.png"));
  folder.write("out/results.json", "{\"experiment\": ");
  CHECK_THAT(refused_by("report out", folder.path), StartsWith("error: out/results.json"));
}

TEST_CASE("a report that cannot be written is refused before anything is drawn, with another place") {
  const Scratch folder(small_experiment());
  drape_ends("run e.yaml --out out --levels 1 --method newton --quiet --no-report", folder);
  CHECK(refused_by("report out out --out nowhere/both.html", folder.path) ==
        "error: nowhere: cannot be written to (No such file or directory); name a page elsewhere with drape "
        "report --out\n");
  if (Command("unshare -rm true", folder.path).wait().exit_code != 0) {
    WARN("no user namespaces here: a read-only folder is not tried");
    return;
  }
  for (const std::string command : {"report out", "view out"}) {
    const Ended ended = Command(
                            "unshare -rm sh -c 'mount --bind out out && mount -o remount,ro,bind out && "
                            "exec " +
                                drape_command + " " + command + "'",
                            folder.path)
                            .wait();
    CHECK(ended.exit_code == 2);
    CHECK(ended.err ==
          "error: out: cannot be written to (Read-only file system); copy the folder to where it can, and "
          "name the copy\n");
  }
}

TEST_CASE("a --set takes one value, so that the config may follow it") {
  const Scratch folder(small_experiment());
  CHECK_THAT(shown_by("check --set levels=1 --set cloth.rows=7 e.yaml", folder.path),
             StartsWith("e.yaml: valid. Vertices by level: 42\n"));
}
