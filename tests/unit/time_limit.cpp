// The limits that tests have themselves: a command that burns time is cut, one that hangs is found, and one
// that other processes keep from running is left alone.

#include "tests/support/time_limit.h"

#include <sched.h>

#include <regex>

#include "core/kernel/threads/stopwatch.h"
#include "tests/support/command.h"
#include "tests/support/folders.h"

using Catch::Matchers::Contains, Catch::Matchers::EndsWith, Catch::Matchers::StartsWith;

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
    CHECK_THAT(ended.err, StartsWith("\nthe test takes more than 0.5 s of processor time. Its processes:\n"));
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
    CHECK_THAT(ended.err, StartsWith("\nthe test hangs: was idle for 0.5 s. Its processes:\n  "));
    CHECK_THAT(ended.err, Contains(" " + std::regex_replace(command, std::regex("'"), "") + "\n"));
    CHECK(watch.seconds() >= 0.5);
  }
}

TEST_CASE("a test case that hangs is named") {
  if (std::getenv("DRAPE_TEST_HANGS")) pause();  // for ever, in the process that is started below
  const Scratch folder;
  const Ended ended = Command("DRAPE_TEST_HANGS=1 exec " + folders::tests() + "/drape_limited 60 0.5 /proc/" +
                                  std::to_string(getpid()) + "/exe 'a test case that hangs is named'",
                              folder.path)
                          .wait();
  CHECK(ended.exit_code == 124);
  CHECK_THAT(ended.err, Contains("the test hangs"));
  CHECK_THAT(ended.out, Contains("\na test case that hangs is named\n") && Contains("SIGTERM"));
}

TEST_CASE("what a test leaves running is ended, and makes it fail") {
  const Scratch folder;
  const auto end_of = [&](const std::string& command) {
    return Command("exec " + folders::tests() + "/drape_limited 60 60 sh -c '" + command + "'", folder.path)
        .wait();
  };
  for (const std::string daemon : {"sleep 1000 &", "setsid sleep 1000 &", "(setsid sleep 1000 &) &"}) {
    INFO(daemon);
    const Ended passed = end_of(daemon), failed = end_of(daemon + " exit 3");
    CHECK(passed.exit_code == 123);
    CHECK(failed.exit_code == 3);
    CHECK_THAT(passed.err, StartsWith("\nthe test left processes running, which were ended:\n  ") &&
                               EndsWith(" sleep 1000\n"));
  }
  CHECK(end_of("sleep 0.2 &").err == "");  // ends by itself
}

TEST_CASE("what a test has started ends with the test, however that ends") {
  for (const int signal : {SIGKILL, SIGTERM, SIGINT}) {
    const Scratch folder;
    Command test("exec " + folders::tests() +
                     "/drape_limited 60 60 sh -c 'setsid sleep 1000 & echo $! > part; mv part number; wait'",
                 folder.path);
    test.wait_until("the process runs", [&] { return std::filesystem::exists(folder / "number"); });
    const pid_t number = std::stoi(text_of(folder / "number"));
    test.wait_until("the process sleeps",
                    [&] { return name_of(number) == std::to_string(number) + " sleep 1000"; });
    test.send_alone(signal);
    CHECK(test.wait().exit_code == 128 + signal);
    wait_until("the process has ended", [&] { return !name_of(number).ends_with(" sleep 1000"); });
  }
}

TEST_CASE("a command's group ends with its object, though the command has ended before") {
  const Scratch folder;
  pid_t number = 0;
  {
    Command command("sleep 1000 & echo $! > number", folder.path);
    REQUIRE(command.wait().exit_code == 0);
    number = std::stoi(text_of(folder / "number"));
    wait_until("the process sleeps", [&] { return name_of(number).ends_with(" sleep 1000"); });
  }
  wait_until("the process has ended", [&] { return !name_of(number).ends_with(" sleep 1000"); });
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

TEST_CASE("a command's processor time is that of its process, after its end too") {
  const Scratch folder;
  Command command("i=0; while [ $i -lt 20000 ]; do i=$((i + 1)); done", folder.path);
  command.wait_until("it has run", [&] { return command.processor_time() > 1e-3; });
  REQUIRE(command.wait().exit_code == 0);
  CHECK(command.processor_time() > 1e-3);
  CHECK(command.processor_time() < 20);
}

TEST_CASE("a wait in Python has the limits of the time that its test takes") {
  const Ended ended = limited("python3 -c 'import sys; sys.path.insert(0, \"" + folders::source() +
                                  "/tests/support\"); import waiting; "
                                  "waiting.wait_until(\"the thaw\", lambda: False, idle=0.5)'",
                              "60", "60");
  CHECK(ended.exit_code == 1);
  CHECK_THAT(ended.err, EndsWith("waiting.InVain: in vain for 0.5 s of idle time: the thaw\n"));
}
