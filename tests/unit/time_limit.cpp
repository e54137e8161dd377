// The limits that tests have themselves: a command that burns time is cut, one that hangs is found, and one
// that other processes keep from running is left alone.

#include "tests/support/time_limit.h"

#include <sched.h>

#include "core/kernel/linear_algebra/stopwatch.h"
#include "tests/support/command.h"
#include "tests/support/folders.h"

using Catch::Matchers::Contains;

namespace {

const std::string burn = "while :; do :; done";

/// How a command ends as a test of ctest's, in limits of processor time and of idleness.
Ended limited(const std::string& command, const std::string& cpu, const std::string& idle) {
  const Scratch folder;
  return Command("exec env -u DRAPE_TEST_SLOWDOWN " + folders::tests() + "/drape_limited " + cpu + " " +
                     idle + " " + command,
                 folder.path)
      .wait();
}

}  // namespace

TEST_CASE("a command that burns processor time is cut") {
  const auto check = [](const std::string& command) {
    INFO(command);
    const Ended ended = limited(command, "0.5", "60");
    CHECK(ended.exit_code == 124);
    CHECK(ended.err == "\nthe test takes more than 0.5 s of processor time\n");
  };
  check("sh -c '" + burn + "'");
  check("sh -c '(" + burn + ") & wait'");  // by its child, while it waits itself
  // By children each of which ends soon.
  check("sh -c 'while :; do sh -c \"i=0; while [ \\$i -lt 1000 ]; do i=\\$((i + 1)); done\"; done'");
}

TEST_CASE("a command that hangs is found") {
  for (const std::string command : {"sleep 1000", "sh -c 'sleep 1000 & wait'", "sh -c 'kill -STOP $$'"}) {
    INFO(command);
    const drape::Stopwatch watch;
    const Ended ended = limited(command, "60", "0.5");
    CHECK(ended.exit_code == 124);
    CHECK(ended.err == "\nthe test hangs: has done nothing for 0.5 s\n");
    CHECK(watch.seconds() >= 0.5);
  }
}

TEST_CASE("a command that others keep from running is not cut") {
  cpu_set_t allowed;
  REQUIRE(sched_getaffinity(0, sizeof allowed, &allowed) == 0);
  int core = 0;
  while (!CPU_ISSET(core, &allowed)) ++core;
  const std::string on_one_core = "taskset -c " + std::to_string(core) + " ";

  const Scratch folder;
  // Each of the others has 1024 / 15 times its weight.
  Command other("exec " + on_one_core + "sh -c '" + burn + "'", folder.path),
      another("exec " + on_one_core + "sh -c '" + burn + "'", folder.path);
  const drape::Stopwatch watch;
  const Ended ended = limited(
      on_one_core + "nice -n 19 sh -c 'i=0; while [ $i -lt 20000 ]; do i=$((i + 1)); done'", "0.5", "0.5");
  CHECK(ended.err == "");
  CHECK(ended.exit_code == 0);
  CHECK(watch.seconds() > 1);  // more than both limits together; or else this tests nothing
}

TEST_CASE("a command within its limit ends as without") {
  CHECK(limited("sh -c 'echo out; echo err >&2; exit 77'", "60", "60").exit_code == 77);
  CHECK(limited("sh -c 'echo out; echo err >&2; exit 77'", "60", "60").out == "out\n");
  CHECK(limited("sh -c 'kill -SEGV $$'", "60", "60").exit_code == 128 + SIGSEGV);
  const Ended none = limited("./no_such_command", "60", "60");
  CHECK(none.exit_code == 126);
  CHECK_THAT(none.err, Contains("./no_such_command: No such file"));
}

TEST_CASE("waiting for what a command is to bring about ends when the command has ended") {
  const Scratch folder;
  Command command("sleep 0.2; touch made", folder.path);
  command.wait_until("the file is made", [&] { return std::filesystem::exists(folder / "made"); });
  CHECK(command.wait().exit_code == 0);
}
