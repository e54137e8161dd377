// What the command says to bad input. Nothing may be written in any of these cases.

#include <sys/stat.h>

#include <cmath>
#include <cstring>

#include "core/app/view/live_server.h"
#include "tests/configs/runs.h"
#include "tests/support/live_client.h"

namespace {

std::string said_of_edit(const std::string& from, const std::string& to) {
  return said_of(replaced(small_experiment(), from, to));
}

}  // namespace

TEST_CASE("the base file of these cases is valid: each case has exactly one fault") {
  CHECK_THAT(shown_by("check e.yaml", Scratch(small_experiment()).path),
             StartsWith("e.yaml: valid. Vertices by level: 36, 121\nMemory to solve them, at most about: ") &&
                 Contains("\nRead: 1 × 1 m, 1 part, edges "));
}

TEST_CASE("a config that is not a regular file is refused without blocking") {
  const Scratch folder;
  REQUIRE(mkfifo((folder / "pipe.yaml").c_str(), 0600) == 0);
  for (const std::string command :
       {"check pipe.yaml", "run pipe.yaml --out out", "sweep pipe.yaml --out out", "check /dev/zero"})
    CHECK_THAT(refused(folder, command), EndsWith(": is a pipe or a device; give a file on a disk\n"));
  fs::create_directory(folder / "out");
  for (const std::string name : {"out/results.json", "out/sweep.json"}) {
    REQUIRE(mkfifo((folder / name).c_str(), 0600) == 0);
    for (const std::string command : {"report out", "table out", "compare out out", "run --resume out"}) {
      CAPTURE(name, command);
      CHECK(drape_with(command, folder.path).exit_code == 2);
    }
    fs::remove(folder / name);
  }
}

TEST_CASE("a start or a reference that is no regular file, or is not finite") {
  const Scratch folder(small_experiment());
  const auto said_with = [&](const std::string& set) {
    return drape_with("check e.yaml --set " + set, folder.path).err;
  };
  REQUIRE(mkfifo((folder / "pipe.ply").c_str(), 0600) == 0);
  for (const std::string key : {"start", "reference"})
    CHECK_THAT(said_with("'" + key + "={file: pipe.ply}'"), Contains("pipe.ply: is a pipe or a device"));
  run_into("out", folder, "--levels 1 --method pcs");
  const std::string rest = text_of(folder / "out/rest/l0.ply");
  const std::size_t third_vertex = rest.find("end_header\n") + 11 + 3 * 24;
  const auto said_of_start = [&](double coordinate) {
    std::string start = rest;
    std::memcpy(start.data() + third_vertex, &coordinate, sizeof coordinate);
    folder.write("start.ply", start);
    return said_with("start.file=start.ply");
  };
  const std::string place = "e.yaml:4:8: start.ply: ";
  check_error(said_of_start(std::nan("")), place + "vertex 3 (counted from 0) has a coordinate that is not ");
  check_error(said_of_start(1e11), place + "1 vertex has too large a coordinate: 3 with 1e+11 m");
  CHECK(said_of_start(0.1) == "");
  CHECK_THAT(
      said_with("cloth.side=0.1 --set 'start.translate=[9e8, 0, 0]'"),
      Contains("the start of level 0: the mesh is 0.127 m across and 9e+08 m from the origin, where "));
}

TEST_CASE("output is short for any number and length of errors") {
  std::string text = small_experiment();
  for (int k = 0; k < 20000; ++k) text += "key_" + std::to_string(k) + ": 1\n";
  const std::string said = said_of(text), word(1000000, 'x');
  CHECK(said.size() < 20000);
  CHECK_THAT(said, EndsWith("error: and 19960 more\n"));
  const std::pair<std::string, std::string> edits[] = {
      {"levels: 2", "levels: " + word},
      {"hinge,", word + ","},
      {"name: small", "name: /" + word},
      {"cascadic: {}", "'/" + word + "': {type: pcs}"},
      {"shape: square", "shape: file, file: " + word + ".obj"}};
  for (const auto& [from, to] : edits) CHECK(said_of_edit(from, to).size() < 3000);
}

TEST_CASE("errors of the file system are sentences") {
  const Scratch folder;
  for (const std::string command : {"check ", "report ", "table ", "run --resume ", "sweep "})
    CHECK_THAT(refused(folder, command + std::string(300, 'x')),
               Contains("File name too long") && !Contains("filesystem error"));
}

TEST_CASE("a port that is taken, and a folder of plugins that is not there") {
  const drape::LiveServer taken(0, {});
  const std::string port = std::to_string(LiveAddress(taken.url()).port);
  const Scratch folder(small_experiment());
  check_error(refused(folder, "run e.yaml --out out --view --port " + port),
              "--port " + port + ": cannot listen on 127.0.0.1:" + port + " (Address already in use); ");
  CHECK(refused(folder, "run e.yaml --out out", "DRAPE_PLUGIN_PATH=nowhere") ==
        "error: DRAPE_PLUGIN_PATH names nowhere, which is not a folder\n");
}

TEST_CASE("a run that may take more memory than there is, is refused before anything is built, or allowed") {
  const Scratch folder(small_experiment());
  CHECK_THAT(refused(folder, "check e.yaml --levels 10 --set cloth.columns=12 --set cloth.rows=12"),
             Catch::Matches(
                 "error: --levels: level 9 would have about 3\\.2e\\+07 vertices and take about 1582 GB of "
                 "memory, where this machine has .* GB; take at most [0-9] levels, or allow it with .*\n"));
  // The shell's limit is the machine's. Sanitizers ask for terabytes of addresses.
  if (DRAPE_SANITIZED) return;
  const std::string line = "ulimit -v 2900000; exec " + drape_command +
                           " check e.yaml --levels 1 --set cloth.columns=300 --set cloth.rows=300";
  const Ended ended = Command(line, folder.path).wait();
  CHECK(ended.exit_code == 2);
  check_error(ended.err, "--levels: level 0 would have about 90000 vertices and take about 3.1 GB of ");
  const Ended allowed = Command(line + " --allow-memory", folder.path).wait();
  CHECK(allowed.exit_code == 0);
  CHECK_THAT(allowed.out, Contains("Vertices by level: 90000\nMemory to solve them, at most about: 3.1 GB"));
}
