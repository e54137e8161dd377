// The commands that read results: export, figures, report, compare and table.

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "core/app/cli/commands.h"
#include "core/app/cli/config_arguments.h"
#include "core/app/experiment/exit_codes.h"
#include "core/app/report/compare.h"
#include "core/app/report/pictures.h"
#include "core/app/report/report.h"
#include "core/app/report/run_collection.h"
#include "core/app/report/run_export.h"
#include "core/app/report/run_table.h"
#include "core/app/run/runner.h"
#include "core/app/sweep/process.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/loader.h"

namespace drape {

namespace {

namespace fs = std::filesystem;
using Folders = std::vector<fs::path>;

/// The vector that "X,Y,Z" spells; nothing for another text, and for a vector whose length says no direction.
std::optional<Eigen::Vector3d> direction_of(const std::string& text) {
  const std::vector<std::string> parts = split(text, ',');
  if (parts.size() != 3) return {};
  Eigen::Vector3d direction;
  for (int k = 0; k < 3; ++k) {
    const std::optional<double> number = number_of(parts[k]);
    if (!number) return {};
    direction[k] = *number;
  }
  const double length = direction.norm();
  if (!(length > 1e-9 && length < 1e9)) return {};
  return direction;
}

/// The sRGB colour that "RRGGBB" spells; nothing for another text.
std::optional<Eigen::Vector3f> colour_of(const std::string& text) {
  if (text.size() != 6 || text.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos) return {};
  Eigen::Vector3f colour;
  for (int k = 0; k < 3; ++k) colour[k] = std::stoi(text.substr(2 * k, 2), nullptr, 16) / 255.0f;
  return colour;
}

void add_picture_width(CLI::App& command, std::optional<int>& width, const std::string& help) {
  add_option(command, "--width PIXELS", width, help)
      ->check(integer_between(
          least_picture_width, greatest_picture_width,
          std::to_string(least_picture_width) + " to " + std::to_string(greatest_picture_width) + " pixels"));
}

/// Writes a sweep's garments. Exits with 1 unless all pass.
int export_sweep(const std::string& folder, const fs::path& to, const ExportOptions& options) {
  if (to.has_extension() || options.level || options.frames || options.as_read || options.rest ||
      !options.uv_unit.empty() || !options.method.empty())
    throw std::runtime_error(
        "of a sweep, --to is a folder, and the finest level of every run is exported to it");
  const RunTable table = export_data_set(folder, to, options);
  std::cout << "written: "
            << std::ranges::count_if(table.rows, [](const TableRow& row) { return row.contains("mesh"); })
            << " of " << table.rows.size() << " to " << printable((to / "index.csv").string()) << "\n";
  return table.all_pass() ? exit_done : exit_not_converged;
}

int export_states(const std::string& folder, const fs::path& file, const ExportOptions& options) {
  if (!file.has_extension()) require_run_or_sweep(folder);  // else a format would be asked for
  if (is_sweep(folder)) return export_sweep(folder, file, options);
  const Folders files = export_run(folder, file, options);
  std::cout << "written: " << printable(files.front().string());
  if (files.size() > 1) std::cout << " to " << printable(files.back().string());
  std::cout << "\n";
  return exit_done;
}

// Python would look into the current folder first, and for an empty part of PYTHONPATH, which -E keeps from
// it until here, and matplotlib evaluates a matplotlibrc of that folder: what lies there is not to be run.
constexpr const char* figures_program = R"(import os, sys
sys.path = [os.path.abspath(part) for part in [*sys.argv.pop(1).split(':'), *sys.path] if part]
here = os.open('.', os.O_PATH)
os.chdir('/')
try:
    import matplotlib
    import drape.paper as figures
except ImportError as error:
    print(f'error: figures are made by the Python module of drape and matplotlib, which {sys.executable} lacks '
          f'({error}); build it with make python, or name its folder in PYTHONPATH', file=sys.stderr)
    sys.exit(2)
os.fchdir(here)
sys.exit(figures.main())
)";

/// The runs, with the measures that they have left.
RunCollection measured(const Folders& folders) {
  Registry registry;
  std::vector<std::string> warnings;
  RunCollection runs = measured_runs(
      folders,
      [&]() -> const Registry& {
        if (registry.of_kind(Metric::kind).empty()) load_plugins(registry, plugin_directories());
        return registry;
      },
      warnings);
  warn_of(warnings);
  return runs;
}

/// Becomes python3, whose exit code is the command's. Throws std::runtime_error for a folder without results,
/// and if python3 does not start.
int make_figures(const std::string& folder, const std::string& out, const std::vector<std::string>& options) {
  require_run_or_sweep(folder);
  measured({folder});
  const char* given = std::getenv("PYTHONPATH");
  std::string path = given ? given : "";
  // The package lies beside bin/ in the build tree, in lib/ once installed, and around the command in a
  // wheel.
  const fs::path root = own_program().parent_path().parent_path();
  for (const fs::path& package : {root / "python/drape", root / "lib/python3/dist-packages/drape", root}) {
    if (package.filename() != "drape" || !fs::exists(package / "__init__.py")) continue;
    path = package.parent_path().string() + ":" + path;
    break;
  }
  const char* python = std::getenv("DRAPE_PYTHON");
  python = python && *python ? python : "/usr/bin/python3";  // for which `make python` builds the module
  std::vector<std::string> words = {python, "-E", "-c", figures_program, path, folder, "--out", out};
  words.insert(words.end(), options.begin(), options.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execvp(python, arguments.data());
  throw std::runtime_error(std::string(python) + ": cannot be started; name a Python in DRAPE_PYTHON");
}

int report(const Folders& folders, fs::path page, std::optional<int> picture_width) {
  const bool several = folders.size() > 1 || is_sweep(folders.front()) ||
                       !fs::is_regular_file(folders.front() / "results.json");
  if (!several && !page.empty())
    throw std::runtime_error(
        "--out is for the page of several runs; a run's own is report.html in its folder");
  if (several && picture_width)
    throw std::runtime_error("--width is for the pictures of one run; a page of several runs has none");
  if (page.empty()) page = folders.front() / "report.html";
  if (folders.size() > 1 && page == folders.front() / "report.html")
    throw std::runtime_error("several folders: name the page with --out, as in --out results/together.html");
  measured(folders);
  if (several) {
    write_runs_report(folders, page);
  } else {
    warn_of(write_report(folders.front(), {}, picture_width));
  }
  std::cout << "report: " << printable(page.string()) << "\n";
  return exit_done;
}

int print_comparison(const Folders& runs, const std::vector<std::string>& bounds) {
  const RunCollection before = measured({runs[0]}), after = measured({runs[1]});
  const Comparison comparison = compare(before, after, bounds);
  std::cout << printable_lines(comparison.text);
  return comparison.broken ? exit_bound_broken : exit_done;
}

int print_table(const Folders& folders, const std::vector<std::string>& columns, const std::string& format) {
  const RunTable table = table_of(measured(folders));
  static const std::map<std::string, TableFormat> formats = {
      {"md", TableFormat::markdown}, {"csv", TableFormat::csv}, {"json", TableFormat::json}};
  const std::string text = table_text(table, columns, formats.at(format));
  std::cout << (format == "json" ? text : printable_lines(text));
  return table.all_pass() ? exit_done : exit_not_converged;
}

}  // namespace

void add_export_command(Commands& commands) {
  struct Options : ExportOptions {
    std::string folder, file;
  };
  const auto o = std::make_shared<Options>();
  CLI::App& command =
      commands.add("export", "write states of a run as glTF, OBJ, PLY, VTP or PNG, a sweep's as a data set",
                   "drape export results/sphere --to sphere.glb --frames",
                   [o] { return export_states(o->folder, o->file, *o); });
  command.add_option("folder", o->folder, "results folder, or a sweep's")->required();
  add_option(
      command, "-o,--to FILE", o->file,
      "file to write: .glb has every level as a scene, with the obstacles; .obj, .ply and .vtp "
      "have the finest level's cloth; .png is a picture of the finest level; of a sweep a folder of OBJ "
      "with JSON")
      ->required();
  add_option(command, "--method NAME", o->method, "method (default: pcs, or the only one that was run)");
  add_option(command, "--level N", o->level, "this level only")->check(number_of_at_least(0));
  command.add_flag("--frames", o->frames,
                   "with .glb: the recorded snapshots of one level (default: the finest) as an animation; "
                   "with .png: those of every level, coarse to fine, as numbered pictures");
  add_picture_width(command, o->picture.width, "with .png: width in pixels (default: 1800)");
  command
      .add_option_function<std::string>(
          "--view", [o = o.get()](const std::string& text) { o->picture.direction = direction_of(text); },
          "with .png: direction towards the camera (default: that of the report's pictures)")
      ->check(must_be("a direction, as in 1,-1,0.5",
                      [](const std::string& text) { return direction_of(text).has_value(); }))
      ->type_name("X,Y,Z");
  command.add_flag("--outline", o->picture.outline,
                   "with .png: draw the outline of the method's coarsest state over the picture");
  command.add_flag("--xray", o->picture.xray, "with .png: let obstacles show faintly through the cloth");
  command
      .add_option_function<std::string>(
          "--colour", [o = o.get()](const std::string& text) { o->picture.colours.cloth = colour_of(text); },
          "with .png: colour of the cloth's front; the back is paler")
      ->check(must_be("a colour of six hexadecimal digits, as in 3a7ca5",
                      [](const std::string& text) { return colour_of(text).has_value(); }))
      ->type_name("RRGGBB");
  command.add_flag("--dark", o->picture.colours.dark, "with .png: before a dark backdrop");
  add_option(
      command, "--uv-unit UNIT", o->uv_unit,
      ".obj, .ply: unit of the texture coordinates of flat pieces: mm, cm, m, inch or normalised, 0 to 1 "
      "(default: as they came)")
      ->check(one_of({"mm", "cm", "m", "inch", "normalised"}));
  command.add_flag("--as-read", o->as_read,
                   "with .obj and .ply: in the unit and axes of the cloth's file, the level of its mesh with "
                   "its vertices");
  command.add_flag("--rest", o->rest, "with .obj and .ply: the level's rest shape in place of a state");
  command.add_flag("--overwrite", o->overwrite, "replace existing files");
}

void add_figures_command(Commands& commands) {
  struct Options {
    std::string folder, out;
    std::vector<std::string> further;  // for Python
  };
  const auto o = std::make_shared<Options>();
  CLI::App& command =
      commands.add("figures", "write a paper's figures of a run or a sweep: PDF, SVG, PNG, CSV and LaTeX",
                   "drape figures results/my_sweep -o figures --width 84 --log",
                   [o] { return make_figures(o->folder, o->out, o->further); });
  const auto flag = [&](const char* name, const char* help) {
    command.add_flag_callback(
        name, [o = o.get(), name] { o->further.emplace_back(name); }, help);
  };
  const auto option = [&](const std::string& name, const char* type, const char* help) -> CLI::Option& {
    return *command
                .add_option_function<std::string>(
                    name,
                    [o = o.get(), name](const std::string& text) { o->further.push_back(name + "=" + text); },
                    help)
                ->type_name(type);
  };
  command.add_option("folder", o->folder, "results folder, or a sweep's")->required();
  add_option(command, "-o,--out DIR", o->out, "folder of the figures, which is made")->required();
  option("--measures", "A,B", "of a sweep: columns of `drape table` that are drawn");
  option("--methods", "A,B", "of a sweep: methods that are drawn");
  option("--width", "MM", "width of a figure (default: 84, and 174 of several panels)")
      .check(number_of_at_least(20));
  option("--style", "FILE", "a matplotlib style: a file, or a name that matplotlib knows");
  flag("--log", "logarithmic axes of measures");
  flag("--overwrite", "replace existing files");
  commands.take_plugins(command);
}

void add_report_commands(Commands& commands) {
  struct Options {
    Folders folders;
    fs::path out;
    std::optional<int> picture_width;
    std::vector<std::string> bounds, columns;
    std::string format = "md";
  };
  const auto o = std::make_shared<Options>();
  CLI::App& report_command =
      commands.add("report", "write the report of a run, of several runs or of a sweep",
                   "drape report results/sphere results/cube -o results/both.html",
                   [o] { return report(o->folders, o->out, o->picture_width); });
  report_command.add_option("folder", o->folders, "folders of runs or sweeps, or one that has them in it")
      ->required();
  add_option(report_command, "-o,--out FILE", o->out,
             "page of several runs (default: report.html in the folder)");
  add_picture_width(report_command, o->picture_width, "width of a run's pictures in pixels (default: 900)");

  CLI::App& compare_command =
      commands.add("compare", "compare two runs or sweeps: what became faster, slower, better or worse",
                   "drape compare results/before results/after --bound seconds=1.1",
                   [o] { return print_comparison(o->folders, o->bounds); });
  compare_command.add_option("runs", o->folders, "the former and the new one")->required()->expected(2);
  add_option(compare_command, "--bound KEY=RATIO", o->bounds,
             "exit with 1 if a quantity exceeds RATIO times its former value; may be repeated");

  CLI::App& table_command = commands.add(
      "table", "print a table of runs and sweeps, one row per method; exits with 1 unless all pass",
      "drape table results/sphere --columns method,status,seconds,energy_released",
      [o] { return print_table(o->folders, o->columns, o->format); });
  table_command.add_option("folder", o->folders, "folders of runs or sweeps, or one that has them in it")
      ->required();
  add_option(table_command, "--format NAME", o->format, "md (default), csv or json")
      ->check(one_of({"md", "csv", "json"}));
  add_option(table_command, "--columns A,B", o->columns, "columns, as in run,status,energy_released")
      ->delimiter(',');

  for (CLI::App* command : {&report_command, &compare_command, &table_command})
    commands.take_plugins(*command);
}

}  // namespace drape
