// The commands of README.md, docs/gallery.md, docs/start and docs/guide/fabrics.md run, with experiments made
// small.

#include <regex>

#include "tests/configs/runs.h"

namespace {

/// What a page has a reader write and type: blocks that name a file (```yaml my_drape.yaml), the lines of its
/// sh blocks that call the command, comments cut, and the commands in cells of tables.
struct Page {
  std::map<std::string, std::string> files;
  std::vector<std::string> commands;
};

Page page_of(const fs::path& file) {
  static const std::regex in_cell("`(build/bin/drape [^`]+)`");
  Page page;
  std::istringstream lines(text_of(file));
  bool shell = false, block = false;
  std::string* written = nullptr;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      const std::size_t name = line.find(' ');
      shell = !block && line.starts_with("```sh");
      written = block || name == line.npos ? nullptr : &page.files[line.substr(name + 1)];
      block = !block;
      continue;
    }
    if (written) *written += line + "\n";
    if (!block && line.starts_with("|"))
      for (std::sregex_iterator it(line.begin(), line.end(), in_cell), end; it != end; ++it)
        page.commands.push_back((*it)[1]);
    if (shell && line.starts_with("build/bin/drape "))
      page.commands.push_back(line.substr(0, line.find(" #")));
  }
  return page;
}

/// A `run` or `fit` that ends in a second or so; anything else as it is, and what goes on with such a run.
std::string made_small(const std::string& command) {
  const bool is_run = command.starts_with("build/bin/drape run ");
  if (!(is_run || command.starts_with("build/bin/drape fit ")) ||
      command.find("--resume") != std::string::npos)
    return command;
  const bool own_mesh = std::regex_search(command, std::regex("configs/(own_mesh|cushion)[.]yaml"));
  return std::regex_replace(command, std::regex(" --levels[ =][0-9]+| --overwrite"), "") +
         (is_run ? " --overwrite" : "") + " --set levels=1 --set newton.force_tolerance=1e-2" +
         (own_mesh ? "" : " --set cloth.columns=0 --set cloth.rows=0 --set cloth.vertices=81");
}

/// Whether a command's experiment needs scanned meshes that `make data` has not made.
bool lacks_meshes(const std::string& command, const fs::path& folder) {
  static const std::regex config("configs/[^ ]+[.]yaml"), mesh("[.][.]/data/[a-z]+[.]ply");
  std::smatch name, data;
  if (!std::regex_search(command, name, config)) return false;
  const fs::path file = folder / name.str();
  const std::string text = text_of(file);
  return std::regex_search(text, data, mesh) && !fs::exists(file.parent_path() / data.str());
}

void run_all(const fs::path& file, std::size_t at_least) {
  INFO(file);
  const fs::path source = folders::source();
  // In a copy, so that what a command writes stays out of the tree.
  const Scratch folder;
  for (const char* name : {"configs", "docs", "benchmarks"})
    fs::copy(source / name, folder / name, fs::copy_options::recursive);
  fs::create_directory_symlink(folders::commands().parent_path(), folder / "build");
  fs::create_directory_symlink(source / "data", folder / "data");
  const Page page = page_of(source / file);
  for (const auto& [name, text] : page.files) {
    if (fs::exists(source / name)) CHECK(text_of(source / name) == text);
    folder.write(name, text);
  }
  CHECK(page.commands.size() >= at_least);
  for (const std::string& command : page.commands) {
    INFO(command);
    if (lacks_meshes(command, folder.path)) continue;
    // Without a display `view` prints the page's address.
    const Ended ended = Command("DISPLAY= WAYLAND_DISPLAY= " + made_small(command), folder.path).wait();
    INFO(ended.err);
    CHECK(ended.exit_code == 0);
  }
}

}  // namespace

TEST_CASE("every command of these pages runs, of the experiments that they show") {
  run_all("README.md", 5);
  run_all("docs/gallery.md", 11);
  run_all("docs/start/first-drape.md", 8);
  run_all("docs/start/own-meshes.md", 3);
  run_all("docs/guide/fabrics.md", 10);
}
