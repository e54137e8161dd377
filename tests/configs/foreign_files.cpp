// What somebody else has put where drape writes: nothing of it is written into, whatever it is.

#include "tests/configs/runs.h"

namespace {

/// A link of a kind to the file `victim`, which holds `text`.
void link_to_victim(const Scratch& folder, const std::string& name, const std::string& text, bool hard) {
  folder.write("victim", text);
  fs::remove(folder / name);
  if (hard)
    fs::create_hard_link(folder / "victim", folder / name);
  else
    fs::create_symlink(fs::absolute(folder / "victim"), folder / name);
}

/// A run that was killed on its second level, in `out`.
void kill_run(const Scratch& folder) {
  DrapeAtWork command(
      "run e.yaml --out out --method newton --no-report --measure -q --checkpoint 0 --set "
      "newton.step_growth=1 "
      "--set newton.step_size=1e-4 --set newton.max_steps=60",
      folder);
  wait_for_lines(command, folder / "out/iterations.csv", 10);
  REQUIRE(command.ended_by(SIGKILL).exit_code == 128 + SIGKILL);
}

const std::string resume = "run --resume out --no-report --measure -q";

}  // namespace

TEST_CASE("new writes under a name that no file has, and never over one") {
  const Scratch folder;
  folder.write("my.yaml.part", "mine");
  drape_ends("new my.yaml", folder);
  CHECK(text_of(folder / "my.yaml.part") == "mine");
  fs::create_symlink("victim", folder / "b.yaml");
  check_error(refused(folder, "new b.yaml"), "b.yaml: exists already; ");
  folder.write("victim", "mine");
  fs::create_symlink("victim", folder / "c.yaml.part");
  drape_ends("new c.yaml", folder);
  CHECK(text_of(folder / "victim") == "mine");
  CHECK(fs::is_symlink(folder / "c.yaml.part"));
}

TEST_CASE("a resumed run appends to files of its own, not to what a link leads to") {
  for (const bool hard : {false, true}) {
    CAPTURE(hard);
    const Scratch folder(small_experiment());
    kill_run(folder);
    for (const std::string name : {"log.jsonl", "iterations.csv"}) {
      const std::string text = text_of(folder / ("out/" + name));
      const Scratch copy;
      fs::copy(folder / "out", copy / "out", fs::copy_options::recursive);
      link_to_victim(copy, "out/" + name, text, hard);
      fs::create_symlink("../victim", copy / ("out/" + name + ".part"));
      drape_ends(resume, copy, 1);
      CHECK(text_of(copy / "victim") == text);
      CHECK(lines_in(copy / ("out/" + name)) > std::count(text.begin(), text.end(), '\n') - 1);
      CHECK_FALSE(fs::is_symlink(copy / ("out/" + name)));
    }
  }
}

TEST_CASE("a lock that is a link, or a file of somebody else, is refused and stays") {
  const Scratch folder(small_experiment());
  kill_run(folder);
  for (const std::string text : {"mine", "process 1 on mine\n"})
    for (const bool hard : {false, true}) {
      if (!hard && text != "mine") continue;
      link_to_victim(folder, "out/checkpoint/lock", text, hard);
      check_error(refused(folder, resume), "out/checkpoint/lock: is not a lock of drape's; move it away");
      check_error(refused(folder, "run e.yaml --out out --overwrite"),
                  "out/checkpoint/lock: is not a lock of ");
      CHECK(text_of(folder / "victim") == text);
    }
  fs::remove(folder / "out/checkpoint/lock");
  drape_ends(resume, folder, 1);
}

TEST_CASE("what a killed run has not written to its end goes when it is resumed") {
  const Scratch folder(small_experiment());
  kill_run(folder);
  const std::vector<std::string> parts = {"results.json.part", "results.json.2.part",
                                          "levels/newton_l0.ply.part", "checkpoint/next.bin.part"};
  for (const std::string& name : parts) folder.write("out/" + name, "");
  const std::vector<std::string> mine = {"notes.part", "levels/mine.ply.part", "results.json.old.part"};
  for (const std::string& name : mine) folder.write("out/" + name, "mine");
  drape_ends(resume, folder, 1);
  for (const std::string& name : parts) CHECK_FALSE(fs::exists(folder / ("out/" + name)));
  for (const std::string& name : mine) CHECK(text_of(folder / ("out/" + name)) == "mine");
}

TEST_CASE("a run does not write into a folder that is a link") {
  const Scratch folder(small_experiment());
  run_into("out", folder, "--levels 1 --method newton");
  fs::create_directory(folder / "photos");
  folder.write("photos/newton_l0.ply", "mine");
  for (const std::string name : {"levels", "pictures", "checkpoint"}) {
    const Scratch copy(small_experiment());
    for (const char* part : {"out", "photos"})
      fs::copy(folder / part, copy / part, fs::copy_options::recursive);
    fs::remove_all(copy / ("out/" + name));
    fs::create_directory_symlink("../photos", copy / ("out/" + name));
    for (const std::string run : {"run e.yaml --out out --overwrite", "run --resume out"})
      check_error(refused(copy, run),
                  "out/" + name + ": is a link, and drape writes into folders of its own; ");
    if (name == "pictures") CHECK(drape_with("report out", copy.path).exit_code > 1);
    CHECK(files_in(copy / "photos").size() == 1);
  }
}

TEST_CASE("report, view and export write through no link, and take no name that a file has") {
  const Scratch folder(small_experiment());
  run_into("out", folder, "--levels 1 --method newton");
  folder.write("victim", "mine");
  const auto check_untouched = [&](const std::string& command, const std::string& name) {
    INFO(command);
    fs::create_directories((folder / name).parent_path());
    for (const std::string ending : {"", ".part"}) {
      fs::remove(folder / (name + ending));
      fs::create_symlink(folder / "victim", folder / (name + ending));
    }
    drape_ends(command, folder);
    CHECK(text_of(folder / "victim") == "mine");
    CHECK_FALSE(fs::is_symlink(folder / name));
    CHECK(fs::is_symlink(folder / (name + ".part")));
    fs::remove(folder / (name + ".part"));
  };
  check_untouched("report out --width 90", "out/report.html");
  check_untouched("report out --width 90", "out/pictures/newton_l0.png");
  fs::remove(folder / "out/report.html");
  fs::create_symlink("victim", folder / "both.html");
  check_error(refused(folder, "report out out -o both.html"),
              "both.html: is there already, and no report of ");
  check_untouched("export out --to cloth.ply --overwrite", "cloth.ply");
}

TEST_CASE("export replaces no result of a run, by whatever way it is named") {
  const Scratch folder(small_experiment());
  run_into("out", folder, "--levels 1 --method newton");
  drape_ends("report out --width 90", folder);
  fs::create_directory_symlink("out/levels", folder / "short");
  for (const std::string name :
       {"out/levels/newton_l0.ply", "out/levels/../levels/newton_l0.vtp", "short/newton_l0.ply",
        "out/rest/l0.ply", "out/pictures/newton_l0.png", "out/start.ply"})
    check_error(refused(folder, "export out --overwrite --to " + name),
                name + ": is the name of a run's own result; name another file\n");
  // A name of the user's own stays theirs, in the run's folder too.
  for (const std::string name : {"out/mine.ply", "out/pictures/mine.png", "out/levels/mine.obj"})
    for (const std::string overwrite : {"", " --overwrite"})
      drape_ends("export out --to " + name + overwrite, folder);
}

TEST_CASE("an exit code of an error comes with a line, in a quiet run too") {
  const Scratch folder(small_experiment());
  const Ended stuck = run_into("out", folder, "--method newton,pcs --set newton.max_steps=2", 1);
  CHECK_THAT(stuck.err, StartsWith("error: pcs: max_steps_reached; level 0 max_steps_reached: ") &&
                            Contains("\nerror: newton: "));
  CHECK(drape_ends("run --resume out -q", folder, 1).err == stuck.err);
  CHECK(run_into("good", folder, "--method newton").err == "");
}

TEST_CASE("no library of the current folder is loaded") {
  const Scratch folder(small_experiment());
  for (const char* library : {"libz.so.1", "libstdc++.so.6", "libm.so.6"})
    folder.write(library, "no library");
  drape_ends("check e.yaml", folder);
}
