// The `drape` command. Its exit codes are in exit_codes.h.

#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "core/app/cli/check_command.h"
#include "core/app/cli/export_command.h"
#include "core/app/cli/fabric_command.h"
#include "core/app/cli/figures_command.h"
#include "core/app/cli/help.h"
#include "core/app/cli/new_command.h"
#include "core/app/cli/plugin_files.h"
#include "core/app/cli/run_command.h"
#include "core/app/cli/sweep_command.h"
#include "core/app/cli/view_command.h"
#include "core/app/experiment/describe.h"
#include "core/app/experiment/exit_codes.h"
#include "core/app/experiment/experiment.h"
#include "core/app/experiment/size_estimate.h"
#include "core/app/files/json_file.h"
#include "core/app/files/machine.h"
#include "core/app/report/compare.h"
#include "core/app/report/report.h"
#include "core/app/report/run_collection.h"
#include "core/app/report/run_table.h"
#include "core/app/run/runner.h"
#include "core/app/sweep/sweep.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/loader.h"
#include "core/kernel/version.h"
#include "core/numerics/step/newton_parameters.h"

namespace {

using namespace drape;

constexpr const char* kinds[] = {"energy", "refiner", "contact", "solver", "metric"};

int list(const std::string& kind, const Registry& registry) {
  const std::vector<std::string> all(std::begin(kinds), std::end(kinds));
  if (!kind.empty() && std::find(all.begin(), all.end(), kind) == all.end())
    throw std::runtime_error("there is no kind \"" + excerpt(kind) + "\"; the kinds are " + joined(all));
  for (const char* k : kinds) {
    if (!kind.empty() && kind != k) continue;
    std::cout << k << "\n";
    for (const RegistryEntry* entry : registry.of_kind(k))
      std::cout << "  " << padded(entry->name, 24) << " " << entry->summary << "\n";
  }
  return exit_done;
}

int describe_plugin(const std::string& name, const Registry& registry) {
  if (name == "experiment") {
    std::cout << describe(schema_of<ExperimentParameters>("experiment"));
    return exit_done;
  }
  if (name == "sweep") {
    std::cout << describe_sweep();
    return exit_done;
  }
  std::vector<std::string> names = {"experiment", "sweep"};
  bool found = false;
  for (const auto& entry : registry.entries()) {
    names.push_back(entry->name);
    if (entry->name != name) continue;
    std::cout << (found ? "\n" : "") << describe(*entry);
    found = true;
  }
  if (found) return exit_done;
  const std::string near = nearest_word(name, names);
  std::cerr << "error: no plugin is called \"" << excerpt(name) << "\"; "
            << (near.empty() ? "`drape list` names them all" : "did you mean \"" + near + "\"?") << "\n";
  return exit_bad_input;
}

/// Newton's settings, which experiments and methods have alike: described once, at this link.
SharedSection newton_section(const std::string& link) {
  return {schema_of<NewtonParameters>("newton"), "[Newton](" + link + ")"};
}

/// Writes every plugin's parameters into FOLDER/KIND/NAME/README.md, if that exists.
int reference_into(const std::filesystem::path& folder, const Registry& registry) {
  const SharedSection newton = newton_section("../../../docs/reference/configuration.md#newton");
  int pages = 0;
  for (const auto& entry : registry.entries()) {
    const std::filesystem::path file = folder / entry->kind / entry->name / "README.md";
    if (!std::filesystem::exists(file)) continue;
    write_file(file, with_parameters(read_file(file), *entry, &newton));
    ++pages;
  }
  if (pages == 0)
    throw std::runtime_error("--readmes " + folder.string() +
                             ": no KIND/NAME/README.md of a plugin there; give the folder `plugins`");
  std::cout << pages << " pages written\n";
  return exit_done;
}

int reference(const Registry& registry) {
  const SharedSection newton = newton_section("#newton");
  std::cout << "# Configuration reference\n\n"
               "```sh\n"
               "drape describe experiment              # a table of this page, in the terminal\n"
               "drape describe pcs                     # a plugin's\n"
               "drape run my_drape.yaml --set newton.force_tolerance=1e-4 --set contact.shapes.dhat=2e-3\n"
               "```\n\n"
               "Made by `drape reference`; do not edit.\n\n## Experiment\n\n"
            << describe_markdown(schema_of<ExperimentParameters>("experiment"), &newton)
            << "\n## Newton\n\nThe section `newton` of an experiment applies to every method. A method's own "
               "`newton` takes precedence, key by key.\n\n"
            << describe_markdown(newton.schema);
  for (const char* kind : kinds) {
    std::cout << "\n## Kind: " << kind << "\n";
    for (const RegistryEntry* entry : registry.of_kind(kind))
      std::cout << "\n" << describe_markdown(*entry, &newton);
  }
  std::cout << "\n## Sweep\n\n" << describe_sweep_markdown();
  return exit_done;
}

int report(const std::vector<std::filesystem::path>& folders, std::filesystem::path page,
           std::optional<int> picture_width) {
  const bool several = folders.size() > 1 || is_sweep(folders.front());
  if (!several && !page.empty())
    throw std::runtime_error(
        "--out is for the page of several runs; a run's own is report.html in its folder");
  if (several && picture_width)
    throw std::runtime_error("--width is for the pictures of one run; a page of several runs has none");
  if (page.empty()) page = folders.front() / "report.html";
  if (folders.size() > 1 && page == folders.front() / "report.html")
    throw std::runtime_error("several folders: name the page with --out, as in --out results/together.html");
  if (several) {
    write_runs_report(folders, page);
  } else {
    require_run_or_sweep(folders.front());
    warn_of(write_report(folders.front(), {}, picture_width));
  }
  std::cout << "report: " << page.string() << "\n";
  return exit_done;
}

nlohmann::ordered_json experiment_json_schema(const Registry& registry) {
  nlohmann::ordered_json schema = json_schema(schema_of<ExperimentParameters>("experiment"), &registry);
  schema["properties"]["methods"].update(named_plugins_schema("solver", registry));
  schema["properties"]["obstacles"].update(obstacles_schema(registry));
  return schema;
}

const std::map<std::string, TableFormat> formats = {
    {"md", TableFormat::markdown}, {"csv", TableFormat::csv}, {"json", TableFormat::json}};

int main_checked(int argc, char** argv) {
  CLI::App app("drape: progressive cloth quasistatics", "drape");
  app.footer(exit_codes_help());
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_help_flag("-h,--help", "print this help and exit");
  app.set_version_flag(
      "--version", [] { return "drape " + version() + " (" + commit() + ")"; }, "print the version and exit");
  app.require_subcommand(1);
  app.failure_message([](const CLI::App* app, const CLI::Error& error) { return refusal(*app, error); });

  const NewCommand new_command(app);

  const CheckCommand check(app);
  const CheckEnergyCommand check_energy(app);
  const RunCommand run(app);
  const ViewCommand view(app);
  const ExportCommand export_command(app);
  const FiguresCommand figures(app);
  const FabricCommand fabric(app);

  std::string kind, plugin, help_on, out, readmes_folder, schema_kind = "experiment";
  std::vector<std::string> report_folders, compared, bounds, columns;
  std::string format = "md";
  CLI::App* report_command =
      app.add_subcommand("report", "write the report of a run, of several runs or of a sweep");
  show_example(*report_command, "drape report results/sphere results/cube -o results/both.html");
  report_command->add_option("folder", report_folders, "results folders, or a sweep's")->required();
  report_command
      ->add_option("-o,--out", out, "page of several runs (default: report.html in a sweep's folder)")
      ->type_name("FILE");
  std::optional<int> picture_width;
  add_picture_width(*report_command, picture_width, "width of a run's pictures in pixels (default: 900)");
  CLI::App* compare_command = app.add_subcommand(
      "compare", "compare two runs or sweeps: what became faster, slower, better or worse");
  show_example(*compare_command, "drape compare results/before results/after --bound seconds=1.1");
  compare_command->add_option("runs", compared, "the former and the new one")->required()->expected(2);
  compare_command
      ->add_option("--bound", bounds,
                   "exit with 1 if a quantity exceeds RATIO times its former value; may be repeated")
      ->type_name("KEY=RATIO")
      ->allow_extra_args(false);
  CLI::App* table_command = app.add_subcommand(
      "table", "print a table of runs and sweeps, one row per method; exits with 1 unless all pass");
  show_example(*table_command, "drape table results/sphere --columns method,status,seconds,energy_released");
  table_command->add_option("folder", report_folders, "results folders, or sweeps'")->required();
  table_command->add_option("--format", format, "md (default), csv or json")
      ->type_name("NAME")
      ->check([](const std::string& name) {
        return formats.contains(name) ? "" : "must be md, csv or json, not " + excerpt(name);
      });
  table_command->add_option("--columns", columns, "columns, as in run,status,energy_released")
      ->type_name("A,B")
      ->delimiter(',')
      ->allow_extra_args(false);
  const SweepCommand sweep(app);
  CLI::App* list_command = app.add_subcommand("list", "list plugins");
  show_example(*list_command, "drape list energy");
  list_command->add_option("kind", kind, "energy, refiner, contact, solver or metric (default: all)");
  CLI::App* describe_command =
      app.add_subcommand("describe", "show a plugin's parameters (or `experiment`'s, `sweep`'s)");
  show_example(*describe_command, "drape describe strain_limit");
  describe_command->add_option("plugin", plugin, "name of the plugin")->required();
  CLI::App* schema_command =
      app.add_subcommand("schema", "print the JSON Schema of experiments (or sweeps), for editors");
  show_example(*schema_command, "drape schema > experiment.schema.json");
  schema_command->add_option("kind", schema_kind, "experiment (default) or sweep")
      ->check(CLI::IsMember({"experiment", "sweep"}));
  CLI::App* help_command = app.add_subcommand("help", "show a command's options and an example");
  show_example(*help_command, "drape help run");
  help_command->add_option("command", help_on, "the command");
  CLI::App* reference_command =
      app.add_subcommand("reference", "print the configuration reference (Markdown)");
  for_developers(*reference_command);
  show_example(*reference_command, "drape reference --readmes plugins");
  reference_command
      ->add_option("--readmes", readmes_folder,
                   "instead, write each plugin's parameters into FOLDER/KIND/NAME/README.md")
      ->type_name("FOLDER");

  PluginFiles plugin_files;
  for (const char* command : {"run", "check", "check-energy", "sweep", "list", "describe", "schema"})
    plugin_files.add_to(*app.get_subcommand(command));

  std::vector<std::string> words = command_words(argc, argv);
  if (words.empty()) {
    std::cerr << app.help();
    return exit_bad_input;
  }
  if (!words[0].starts_with("-")) require_command(app, words[0]);
  std::reverse(words.begin(), words.end());  // as the parser takes them
  try {
    app.parse(words);
    run.check();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_done : exit_bad_input;
  }

  if (new_command.chosen()) return new_command.run();
  if (view.chosen()) return view.run();
  if (export_command.chosen()) return export_command.run();
  if (figures.chosen()) return figures.run();
  if (fabric.chosen()) return fabric.run();
  if (*report_command) {
    return report({report_folders.begin(), report_folders.end()}, out, picture_width);
  }
  if (*compare_command) {
    const RunCollection before = read_runs({compared[0]}), after = read_runs({compared[1]});
    const Comparison comparison(before, after, parse_bounds(bounds, before, after));
    std::cout << printable_lines(comparison.text());
    return comparison.broken() ? exit_bound_broken : exit_done;
  }
  if (*table_command) {
    const RunTable table = table_of(read_runs({report_folders.begin(), report_folders.end()}));
    const std::string text = table_text(table, columns, formats.at(format));
    std::cout << (format == "json" ? text : printable_lines(text));
    return table.all_pass() ? exit_done : exit_not_converged;
  }
  if (sweep.job_chosen()) return sweep.run_job();
  plugin_files.compile();
  Registry registry;
  load_plugins(registry, plugin_directories());
  if (run.chosen()) return run.run(registry);
  if (sweep.chosen()) return sweep.run(registry);
  if (check.chosen()) return check.run(registry);
  if (check_energy.chosen()) return check_energy.run(registry);
  if (*list_command) return list(kind, registry);
  if (*describe_command) return describe_plugin(plugin, registry);
  if (*schema_command) {
    if (schema_kind == "sweep")
      std::cout << json_text(sweep_json_schema(), 2) << "\n";
    else
      std::cout << json_text(experiment_json_schema(registry), 2) << "\n";
    return exit_done;
  }
  if (*reference_command)
    return readmes_folder.empty() ? reference(registry) : reference_into(readmes_folder, registry);
  return exit_bad_input;
}

}  // namespace

namespace {

/// Opens those of the three standard streams that are closed on /dev/null: otherwise the first files of a run
/// would take their places, and what is printed would go into them.
void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) == -1 && open("/dev/null", O_RDWR) != stream) std::_Exit(exit_aborted);
}

}  // namespace

int main(int argc, char** argv) {
  // Exceeding a file size limit is reported as an error instead of ending the process.
  std::signal(SIGXFSZ, SIG_IGN);
  open_standard_streams();
  const auto end = [](const std::string& message, int exit_code) {
    std::cerr << "error: " << printable(message) << "\n";
    return exit_code;
  };
  try {
    const int exit_code = main_checked(argc, argv);
    if (!std::cout.flush()) return end("standard output cannot be written to", exit_aborted);
    return exit_code;
  } catch (const RunAborted& error) {
    return end(error.what(), exit_aborted);
  } catch (const WriteError& error) {
    return end(error.what(), exit_aborted);
  } catch (const nlohmann::json::exception& error) {
    return end(std::string("a results file is not as drape writes it (") + error.what() +
                   "); run the experiment again",
               exit_bad_input);
  } catch (const std::exception& error) {
    return end(reason_of(error), exit_bad_input);
  }
}
