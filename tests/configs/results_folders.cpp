// Which folders a run may have for its results, and what of them it replaces.

#include "tests/configs/runs.h"

TEST_CASE("a results folder may not be a link that leads nowhere") {
  const Scratch folder(small_experiment());
  fs::create_symlink("gone", folder / "link");  // which is left there
  check_error(refused(folder, "run e.yaml --out link"),
              "link: is a link to gone, which does not exist; make that folder, or name ");
}

TEST_CASE("a link to a folder, as on a larger disk, is a results folder") {
  const Scratch folder(small_experiment());
  fs::create_directory(folder / "disk");
  fs::create_directory_symlink("disk", folder / "link");
  run_into("link", folder, "--levels 1 --method pcs");
  CHECK(fs::is_symlink(folder / "link"));
  CHECK(fs::exists(folder / "disk/results.json"));
}

TEST_CASE("a run that cannot begin, since no file takes a byte, leaves nothing") {
  const Scratch folder(small_experiment());
  const Ended ended =
      Command("ulimit -f 0 && exec " + drape_command + " run e.yaml --out new/out", folder.path).wait();
  CHECK(ended.exit_code == 2);  // its sentence finds no file either
  CHECK_FALSE(fs::exists(folder / "new"));
}

TEST_CASE("names that the file system does not allow are refused before the first write") {
  const auto experiment = [](const std::string& method) {
    return replaced(small_experiment(), "  pcs: {}\n", "  " + method + ": {type: pcs}\n");
  };
  CHECK_THAT(refused_alike(Scratch(experiment(std::string(201, 'm')))),
             Contains("it has 201 bytes, and may have 200"));
  const Scratch folder(small_experiment());
  CHECK_THAT(refused(folder, "run e.yaml --out a/b/" + std::string(300, 'x')),
             Contains("cannot make the results folder (File name too long); name another with --out"));
  std::string deep = "d";
  for (int k = 0; k < 45; ++k) deep += "/" + std::string(90, 'd');
  CHECK_THAT(refused(folder, "run e.yaml --out " + deep), Contains("less deep with --out"));
  CHECK_THAT(said_of(experiment("\"a\xff\"")), StartsWith("error: "));
  run_into("out", Scratch(experiment(std::string(200, 'm'))), "--method all");
}

TEST_CASE("earlier results stay without --overwrite, which removes only a run's own files") {
  const bool with_results = GENERATE(true, false);
  CAPTURE(with_results);
  const Scratch folder(small_experiment());
  run_into("out", folder, "--levels 1 --method pcs");
  REQUIRE(fs::exists(folder / "out/snapshots/pcs_l0.bin"));
  fs::create_directories(folder / "out/pictures/mine");
  const std::vector<std::string> own = {"notes.txt",         "pictures/mine.png", "pictures/mine/pcs_l0.png",
                                        "levels/pcs_l0.obj", "fields/pcs_l0.ply", "rest/level0.ply",
                                        "obstacles/my0.ply", "checkpoint/mine"};
  for (const std::string& name : own) folder.write("out/" + name, "mine");
  const std::vector<std::string> added = {"pictures/pcs_l0_on_l1.png", "fields/pcs_l0_l1.ply",
                                          "errors.csv.part"};
  for (const std::string& name : added) folder.write("out/" + name, "");
  if (!with_results) fs::remove(folder / "out/results.json");
  const std::string run = "run e.yaml --out out --quiet --no-report --measure --levels 1 --method newton";
  check_error(refused(folder, run), "out: holds the results of another run; name another folder ");
  drape_ends(run + " --overwrite", folder);
  const auto files = files_in(folder / "out");
  for (const std::string& name : own) CHECK(files.at(name) == "mine");
  CHECK(files.count("levels/newton_l0.ply") == 1);
  for (const auto& [name, bytes] : files) {
    INFO(name);
    CHECK((name.find("pcs") == name.npos || bytes == "mine"));
    CHECK(fs::path(name).extension() != ".part");
  }
}

TEST_CASE("a folder is a run's only with results or a lock of drape's own") {
  const Scratch folder(small_experiment());
  fs::create_directory(folder / "mine");
  folder.write("mine/config.yaml", "mine");
  folder.write("mine/writable.part", "mine too");
  for (const bool with_results : {false, true}) {
    if (with_results) folder.write("mine/results.json", "{\"accuracy\": 0.9}");
    for (const std::string overwrite : {"", " --overwrite"})
      check_error(
          refused(folder, "run e.yaml --out mine" + overwrite),
          "mine/config.yaml: is there already, and not from a run; name another results folder with ");
  }
  CHECK(refused(folder, "run --resume mine") ==
        "error: mine: holds no run; give the results folder of one\n");
  fs::create_directory(folder / "sweep");
  folder.write("sweep/sweep.json", "{}");
  check_error(refused(folder, "run e.yaml --out sweep"), "sweep: is a sweep's folder; ");
}

TEST_CASE("--overwrite removes no file that the new run reads, and may repeat a run from its config.yaml") {
  const Scratch folder(small_experiment());
  const std::string options = "--levels 1 --method pcs ";
  run_into("first", folder, options);
  const std::string mesh = (folder / "first/levels/pcs_l0.ply").string();
  check_error(
      refused(folder, "run e.yaml --overwrite --out first --set contact=[ipc] --set 'obstacles=[{mesh: " +
                          mesh + ", translate: [0, 0, -0.9]}]'"),
      mesh + ": is read by this experiment, and --overwrite would remove it; copy it, or name another ");
  run_into("out", folder, options + "--set start.file=first/rest/l0.ply");
  fs::copy(folder / "out", folder / "copy", fs::copy_options::recursive);
  CHECK(
      drape_ends("run out/config.yaml --overwrite --out out --quiet --no-report --measure " + options, folder)
          .err == "");
  check_same_files(folder / "out", folder / "copy", {"start.ply", "levels/pcs_l0.ply"});
}

TEST_CASE("a file where a run has a folder, or a folder where it has a file, is refused and not removed") {
  for (const std::string name : {"pictures", "iterations.csv/mine"}) {
    const Scratch folder(small_experiment());
    fs::create_directories(folder / "out/checkpoint");
    folder.write("out/checkpoint/lock", "");
    fs::create_directories((folder / ("out/" + name)).parent_path());
    folder.write("out/" + name, "mine");
    check_error(refused(folder, "run e.yaml --out out --overwrite"),
                "out/" + name.substr(0, name.find('/')) + ": is not what a run has by this name; ");
  }
}

TEST_CASE("a folder at the name of any file of a run is refused before anything is touched") {
  const Scratch folder(small_experiment());
  run_into("out", folder, "--levels 1 --method pcs");
  for (const std::string name : {"config.yaml", "levels/pcs_l0.ply", "snapshots/newton_l3.bin",
                                 "checkpoint/state.bin", "checkpoint/next.bin", "pictures/pcs_l0.png"}) {
    const Scratch copy(small_experiment());
    fs::copy(folder / "out", copy / "out", fs::copy_options::recursive);
    fs::remove(copy / ("out/" + name));
    fs::create_directories(copy / ("out/" + name));
    copy.write("out/" + name + "/mine", "mine");
    check_error(refused(copy, "run e.yaml --out out --overwrite --levels 1 --method pcs"),
                "out/" + name + ": is not what a run has by this name; move it, or name another ");
    check_error(refused(copy, "run --resume out"), "out/" + name + ": is not what a run has by this ");
  }
}

TEST_CASE("a run that was killed before its first write blocks no other run") {
  for (int made = 1; made <= 3; ++made) {  // what it makes, in its order
    const Scratch folder(small_experiment());
    fs::create_directories(folder / "out/checkpoint");
    if (made > 1) folder.write("out/checkpoint/lock", "");
    if (made > 2) fs::create_directory(folder / "out/levels");
    CAPTURE(made);
    run_into("out", folder, "--levels 1 --method pcs");
  }
}
