#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "core/app/cli/commands.h"
#include "core/app/report/run_collection.h"

namespace drape {

namespace {

constexpr const char* program = R"(import sys
try:
    import matplotlib
    import drape.figures as figures
except ImportError as error:
    print(f'error: figures are made by the Python module of drape and matplotlib, which {sys.executable} lacks '
          f'({error}); build it with make python, or name its folder in PYTHONPATH', file=sys.stderr)
    sys.exit(2)
sys.exit(figures.main())
)";

/// Becomes python3, whose exit code is the command's. Throws std::runtime_error for a folder without results,
/// and if python3 does not start.
int make_figures(const std::string& folder, const std::string& out) {
  namespace fs = std::filesystem;
  require_run_or_sweep(folder);
  const fs::path command = fs::read_symlink("/proc/self/exe");
  // In the build tree the package lies beside bin/, once installed where Python looks for it.
  if (const fs::path built = command.parent_path().parent_path() / "python"; fs::exists(built / "drape")) {
    const char* path = std::getenv("PYTHONPATH");
    setenv("PYTHONPATH", (built.string() + (path && *path ? std::string(":") + path : "")).c_str(), 1);
  }
  const char* python = std::getenv("DRAPE_PYTHON");
  python = python && *python ? python : "/usr/bin/python3";  // for which `make python` builds the module
  execl(python, python, "-c", program, folder.c_str(), "--out", out.c_str(), nullptr);
  throw std::runtime_error(std::string(python) + ": cannot be started; name a Python in DRAPE_PYTHON");
}

}  // namespace

void add_figures_command(Commands& commands) {
  struct Options {
    std::string folder, out;
  };
  const auto o = std::make_shared<Options>();
  CLI::App& command = commands.add(
      "figures", "write a paper's figures of a run or a sweep: SVG, PNG, CSV and LaTeX",
      "drape figures results/sphere -o figures", [o] { return make_figures(o->folder, o->out); });
  command.add_option("folder", o->folder, "results folder, or a sweep's")->required();
  command.add_option("-o,--out", o->out, "folder of the figures, which is made")
      ->type_name("DIR")
      ->required();
}

}  // namespace drape
