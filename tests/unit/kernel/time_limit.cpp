// The limits that tests have themselves: a command that burns time is cut, one that hangs is found, and one
// that other processes keep from running is left alone.

#include "tests/support/time_limit.h"

#include <regex>

#include "core/kernel/threads/stopwatch.h"
#include "tests/support/command.h"
#include "tests/support/folders.h"

using Catch::Contains, Catch::EndsWith, Catch::StartsWith;

namespace {

const std::string burn = "while :; do :; done", drape_limited = (folders::tests() / "drape_limited").string();

/// How a command ends as a test of ctest's, in limits of processor time and of idleness.
Ended limited(const std::string& command, const std::string& cpu, const std::string& idle) {
  const Scratch folder;
  return Command("exec env -u DRAPE_TEST_SLOWDOWN " + drape_limited + " " + cpu + " " + idle + " " + command,
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

TEST_CASE("what a test leaves running is ended, and makes it fail") {
  const Scratch folder;
  const auto end_of = [&](const std::string& command) {
    return Command("exec " + drape_limited + " 60 60 sh -c '" + command + "'", folder.path).wait();
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

TEST_CASE("a command within its limit ends as without") {
  const Ended with_code = limited("sh -c 'echo out; exit 77'", "60", "60");
  CHECK(with_code.exit_code == 77);
  CHECK(with_code.out == "out\n");
  CHECK(limited("sh -c 'kill -SEGV $$'", "60", "60").exit_code == 128 + SIGSEGV);
  const Ended none = limited("./no_such_command", "60", "60");
  CHECK(none.exit_code == 126);
  CHECK_THAT(none.err, Contains("./no_such_command: No such file"));
}

TEST_CASE("a wait in Python has the limits of the time that its test takes") {
  const Ended ended = limited("python3 -c 'import sys; sys.path.insert(0, \"" +
                                  (folders::source() / "tests/support").string() +
                                  "\"); import waiting; "
                                  "waiting.wait_until(\"the thaw\", lambda: False, idle=0.5)'",
                              "60", "60");
  CHECK(ended.exit_code == 1);
  CHECK_THAT(ended.err, EndsWith("waiting.InVain: in vain for 0.5 s of idle time: the thaw\n"));
}
