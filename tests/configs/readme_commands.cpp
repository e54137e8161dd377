// The README's commands do what it says: each is run, with experiments made small.

#include <catch2/catch.hpp>
#include <regex>

#include "tests/support/command.h"
#include "tests/support/folders.h"

namespace fs = std::filesystem;

namespace {

/// The lines of the README's sh blocks that call the command, continued lines joined, comments cut.
std::vector<std::string> readme_commands() {
  std::vector<std::string> commands;
  std::istringstream lines(text_of(fs::path(folders::source()) / "README.md"));
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) inside = !inside && line.starts_with("```sh");
    while (inside && line.ends_with("\\")) {
      std::string more;
      std::getline(lines, more);
      line = line.substr(0, line.size() - 1) + more;
    }
    if (inside && line.starts_with("build/bin/drape ")) commands.push_back(line.substr(0, line.find(" #")));
  }
  return commands;
}

/// A `run` that ends in a second or so; anything else as it is, and what goes on with such a run.
std::string made_small(const std::string& command) {
  if (!command.starts_with("build/bin/drape run ") || command.find("--resume") != std::string::npos)
    return command;
  return std::regex_replace(command, std::regex(" --levels[ =][0-9]+"), "") +
         " --overwrite --set levels=1 --set cloth.columns=8 --set cloth.rows=8 --set cloth.vertices=64"
         " --set newton.force_tolerance=1e-2";
}

}  // namespace

TEST_CASE("every command of README.md runs") {
  const fs::path source = folders::source();
  // In a copy, so that what a command writes stays out of the tree.
  const Scratch folder;
  for (const char* name : {"configs", "docs", "benchmarks"})
    fs::copy(source / name, folder / name, fs::copy_options::recursive);
  fs::create_directory_symlink(fs::path(folders::commands()).parent_path(), folder / "build");
  const std::vector<std::string> commands = readme_commands();
  CHECK(commands.size() >= 3);
  for (const std::string& command : commands) {
    INFO(command);
    const Ended ended = Command(made_small(command), folder.path).wait();
    INFO(ended.err);
    CHECK(ended.exit_code == 0);
  }
}
