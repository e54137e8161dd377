// Refusals as data: what drape says to the commands in tests/refusals. Nothing may be written by any.

#include "tests/configs/runs.h"

namespace {

/// A command of `drape`, and how each line begins that it is refused with.
struct Refused {
  std::string command;
  std::vector<std::string> lines = {};
};

/// The commands "# $ drape …" of a file, each with the lines "# …" below it.
std::vector<Refused> refusals_in(const fs::path& file) {
  const std::string mark = "# $ drape ";
  std::vector<Refused> all;
  std::vector<std::string>* below = nullptr;
  std::ifstream text(file);
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with(mark))
      below = &all.emplace_back(Refused{line.substr(mark.size())}).lines;
    else if (!line.starts_with("# "))
      below = nullptr;
    else if (below)
      below->push_back(line.substr(2));
  }
  return all;
}

void check_lines(const std::string& said, const std::vector<std::string>& beginnings) {
  std::istringstream lines(said);
  std::string line;
  for (const std::string& beginning : beginnings) {
    CHECK(std::getline(lines, line));
    CHECK_THAT(line, StartsWith(beginning));
  }
  CHECK_FALSE(std::getline(lines, line));
}

}  // namespace

TEST_CASE("every command of tests/refusals is refused in the words below it") {
  const Scratch folder;
  fs::copy(folders::source() / "tests/refusals", folder.path, fs::copy_options::recursive);
  for (const auto& entry : fs::directory_iterator(folders::source() / "tests/refusals")) {
    if (entry.path().extension() != ".yaml") continue;
    const std::vector<Refused> refusals = refusals_in(entry.path());
    INFO(entry.path());
    CHECK(!refusals.empty());
    for (const auto& [command, lines] : refusals) {
      INFO("drape " << command);
      CHECK(!lines.empty());
      const std::string said = refused(folder, command);
      check_lines(said, lines);
      if (command.starts_with("check ")) CHECK(refused(folder, "run" + command.substr(5)) == said);
    }
  }
}
