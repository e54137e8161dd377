// The `drape` command. Exit codes: 0 done and converged, 1 a run that ended otherwise, 2 bad input.

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <fstream>
#include <iostream>
#include <thread>

#include "core/cli/sweep_command.h"
#include "core/experiment/experiment.h"
#include "core/experiment/machine.h"
#include "core/experiment/run_folder.h"
#include "core/experiment/runner.h"
#include "core/experiment/session.h"
#include "core/experiment/start_repair.h"
#include "core/numerics/parallel.h"
#include "core/plugin/describe.h"
#include "core/plugin/loader.h"
#include "core/plugin/words.h"
#include "core/report/compare.h"
#include "core/report/report.h"
#include "core/report/run_set.h"
#include "core/report/run_table.h"
#include "core/report/runs_report.h"
#include "core/report/tables.h"
#include "core/sweep/sweep.h"
#include "core/version.h"
#include "core/view/live_view.h"

namespace {

using namespace drape;

constexpr int exit_not_converged = 1, exit_bound_broken = 1, exit_bad_input = 2;
constexpr const char* kinds[] = {"energy", "refiner", "contact", "solver", "metric"};

volatile std::sig_atomic_t stop_signal = 0;

void on_signal(int number) {
  if (stop_signal) std::_Exit(128 + number);  // the second one does not wait
  stop_signal = number;
}

void stop_on_signals() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

/// How a run is shown while it goes.
struct ViewArguments {
  bool view = false, keep = false;
  int port = 0;

  void add_to(CLI::App& command) {
    CLI::Option* show =
        command.add_flag("--view", view, "serve a live view of the run on 127.0.0.1; prints its address");
    command.add_option("--port", port, "port of the live view (default: one that is free)")
        ->check([](const std::string& text) -> std::string {
          const std::optional<int> number = parse_integer(text);
          return number && *number >= 0 && *number <= 65535 ? "" : "must be a port, 0 to 65535, not " + text;
        })
        ->needs(show);
    command.add_flag("--view-keep", keep, "go on serving the view after the run, until Ctrl-C")->needs(show);
  }
};

struct ConfigArguments {
  std::string config;
  std::vector<std::string> sets;
  int levels = 0;
  bool allow_start_repair = false;
  CLI::Option* config_option = nullptr;

  void add_to(CLI::App& command) {
    config_option = command.add_option("config", config, "experiment file (YAML)")->required();
    command.add_option("--set", sets, "override one value, as in newton.step_size=0.1; may be repeated")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    command.add_option("--levels", levels, "number of levels, in place of the experiment's")
        ->check(positive_integer);
    command.add_flag("--allow-start-repair", allow_start_repair,
                     "move a start that touches something up or to a side until it does not");
  }

  Overrides overrides() const {
    Overrides all;
    for (const std::string& set : sets) {
      const std::size_t equals = set.find('=');
      if (equals == std::string::npos || equals == 0)
        throw std::runtime_error("--set " + set +
                                 ": write it as key=value, as in --set newton.step_size=0.1");
      all.emplace_back(set.substr(0, equals), set.substr(equals + 1));
    }
    if (levels > 0) all.emplace_back("levels", std::to_string(levels));
    return all;
  }
};

int report_errors(const ConfigErrors& errors) {
  for (const ConfigError& error : errors) std::cerr << "error: " << error.text() << "\n";
  return exit_bad_input;
}

/// An experiment and the scene built from it; errors are printed and leave both empty.
struct Loaded {
  std::optional<Experiment> experiment;
  std::unique_ptr<Scene> scene;
  int exit_code = 0;

  Loaded(const ConfigArguments& arguments, const Registry& registry) {
    ConfigErrors errors;
    experiment = read_experiment(arguments.config, arguments.overrides(), registry, errors);
    if (errors.empty())
      scene = build_scene(*experiment, errors,
                          arguments.allow_start_repair ? TouchingStart::kept : TouchingStart::refused);
    if (scene && arguments.allow_start_repair) repair(errors);
    if (!errors.empty()) exit_code = report_errors(errors);
  }

 private:
  void repair(ConfigErrors& errors) {
    const Eigen::Vector3d way = repair_start(*experiment, *scene, errors);
    if (way.isZero(0)) return;
    scene = build_scene(*experiment, errors);
    if (errors.empty())
      std::fprintf(stderr, "start moved by (%.4g, %.4g, %.4g) m so that it touches nothing\n", way.x(),
                   way.y(), way.z());
  }
};

/// Runs an experiment, or goes on with one where the checkpoint says.
int run(const Experiment& experiment, const Scene& scene, const ViewArguments& showing, RunOptions options,
        std::optional<Checkpoint> checkpoint) {
  stop_on_signals();
  options.stop = [] { return stop_signal != 0; };
  std::optional<LiveView> view;
  if (showing.view) {
    view.emplace(experiment, scene, options.methods, showing.port);
    options.view = &*view;
    std::cout << "view: " << view->url() << std::endl;
  }
  const bool converged = checkpoint ? resume_experiment(experiment, scene, options, std::move(*checkpoint))
                                    : run_experiment(experiment, scene, options);
  if (options.report)
    std::cout << "report: " << (options.out / "report.html").string() << "\n";
  else
    std::cout << "results: " << (options.out / "results.json").string() << "\n";
  const bool stopped = stop_signal != 0 || (view && view->stop_requested());
  const int as_signal = stop_signal ? static_cast<int>(stop_signal) : SIGINT;  // the view's Stop is a Ctrl-C
  if (showing.keep && !stop_signal) {
    std::cout << "the view stays at " << view->url() << " until Ctrl-C" << std::endl;
    while (!stop_signal) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  if (stopped) {
    std::cerr << "stopped on request; everything up to then is in " << options.out.string() << "\n";
    return 128 + as_signal;
  }
  return converged ? 0 : exit_not_converged;
}

int run(const ConfigArguments& arguments, const ViewArguments& showing, RunOptions options,
        const Registry& registry) {
  Loaded loaded(arguments, registry);
  if (loaded.exit_code) return loaded.exit_code;
  if (options.out.empty())
    options.out = std::filesystem::path("results") / loaded.experiment->parameters.name;
  return run(*loaded.experiment, *loaded.scene, showing, std::move(options), std::nullopt);
}

/// What `run` goes on with, in place of an experiment file.
struct ResumeArguments {
  std::string folder;
  std::optional<int> level;

  void add_to(CLI::App& command) {
    command.add_option(
        "--resume", folder,
        "results folder of an interrupted run: go on with it; or, with --set, --levels, --level "
        "or --method, and --out: flow on from a state of it in another folder");
    command.add_option("--level", level, "of the state to flow on from (default: the last one of the run)");
  }
};

/// Goes on with an interrupted run, in its folder.
int resume(const std::filesystem::path& folder, const ViewArguments& showing, RunOptions options,
           const Registry& registry) {
  if (is_complete(folder)) {
    std::cout << folder.string() << ": the run is complete; there is nothing to go on with\n";
    return 0;
  }
  std::string warning;
  Checkpoint checkpoint = checkpoint_to_resume(folder, warning);
  if (!warning.empty()) std::cerr << "warning: " << warning << "\n";
  ConfigErrors errors;
  const auto experiment = read_experiment(folder / "config.yaml", {}, registry, errors);
  const auto scene = experiment ? build_scene(*experiment, errors, TouchingStart::kept) : nullptr;
  if (scene && checkpoint.own_start)
    begin_from(*experiment, *scene, checkpoint.first_level, *checkpoint.own_start, errors);
  if (!errors.empty()) return report_errors(errors);
  options.out = folder;
  options.methods = checkpoint.methods;
  return run(*experiment, *scene, showing, std::move(options), std::move(checkpoint));
}

/// Flows on from a state of a run, under an experiment that may be changed, in a folder of its own.
int flow_on(const ResumeArguments& resuming, const ConfigArguments& arguments, const ViewArguments& showing,
            RunOptions options, const Registry& registry) {
  const std::filesystem::path folder = resuming.folder, config = folder / "config.yaml";
  if (options.methods.size() > 1)
    throw std::runtime_error("--resume with --method: name one method, whose state is to flow on");
  const SavedState state =
      saved_state(folder, options.methods.empty() ? "" : options.methods[0], resuming.level);
  ConfigErrors errors;
  const auto before = read_experiment(config, {}, registry, errors);
  if (!before) return report_errors(errors);
  const auto experiment = read_experiment(config, arguments.overrides(), registry, errors);
  if (experiment) refuse_other_cloth(*before, *experiment, state.level, errors);
  const auto scene = errors.empty() ? build_scene(*experiment, errors, TouchingStart::kept) : nullptr;
  if (scene) begin_from(*experiment, *scene, state.level, state.x, errors);
  if (!errors.empty()) return report_errors(errors);
  options.methods = {state.method};
  options.first_level = state.level;
  options.begun_from =
      folder.string() + ", method " + state.method + ", level " + std::to_string(state.level);
  return run(*experiment, *scene, showing, std::move(options), std::nullopt);
}

int run(const ResumeArguments& resuming, const ConfigArguments& arguments, const ViewArguments& showing,
        RunOptions options, const Registry& registry) {
  if (resuming.folder.empty()) {
    if (resuming.level) throw std::runtime_error("--level is of a saved state; name its run with --resume");
    return run(arguments, showing, std::move(options), registry);
  }
  const auto refuse = [](const std::string& why) { throw std::runtime_error("--resume " + why); };
  if (!arguments.config.empty())
    refuse("takes the experiment from the run's own config.yaml; leave out " + arguments.config +
           ", and change parameters with --set KEY=VALUE");
  if (arguments.allow_start_repair)
    refuse("begins with a state that touches nothing; leave out --allow-start-repair");
  const bool changed =
      !arguments.sets.empty() || arguments.levels > 0 || resuming.level || !options.methods.empty();
  if (!changed && !options.out.empty())
    refuse(
        "goes on in the run's own folder; leave out --out, or say with --set, --level or --method what "
        "is to be another run");
  if (!changed && options.overwrite) refuse("goes on with the results that are there; leave out --overwrite");
  if (!changed) return resume(resuming.folder, showing, std::move(options), registry);
  if (options.out.empty())
    refuse("with --set, --levels, --level or --method is another run; name its folder with --out");
  std::error_code error;
  if (std::filesystem::equivalent(options.out, resuming.folder, error))
    refuse(
        "with --set, --levels, --level or --method leaves the run that it begins from as it is; name "
        "another folder with --out");
  return flow_on(resuming, arguments, showing, std::move(options), registry);
}

int check(const ConfigArguments& arguments, const Registry& registry) {
  Loaded loaded(arguments, registry);
  if (loaded.exit_code) return loaded.exit_code;
  std::cout << arguments.config << ": sound.";
  for (const Level& level : loaded.scene->hierarchy.levels)
    std::cout << (level.index ? ", " : " Vertices by level: ") << level.vertex_count();
  std::cout << "\n";
  return 0;
}

int list(const std::string& kind, const Registry& registry) {
  const std::vector<std::string> all(std::begin(kinds), std::end(kinds));
  if (!kind.empty() && std::find(all.begin(), all.end(), kind) == all.end())
    throw std::runtime_error("there is no kind \"" + kind + "\"; the kinds are " + joined(all));
  for (const char* k : kinds) {
    if (!kind.empty() && kind != k) continue;
    std::cout << k << "\n";
    for (const RegistryEntry* entry : registry.of_kind(k))
      std::printf("  %-24s %s\n", entry->name.c_str(), entry->summary.c_str()), std::fflush(stdout);
  }
  return 0;
}

int describe_plugin(const std::string& name, const Registry& registry) {
  if (name == "experiment") {
    std::cout << describe(schema_of<ExperimentParameters>("experiment"));
    return 0;
  }
  if (name == "sweep") {
    std::cout << describe_sweep();
    return 0;
  }
  std::vector<std::string> names = {"experiment", "sweep"};
  bool found = false;
  for (const auto& entry : registry.entries()) {
    names.push_back(entry->name);
    if (entry->name != name) continue;
    std::cout << (found ? "\n" : "") << describe(*entry);
    found = true;
  }
  if (found) return 0;
  const std::string near = nearest_word(name, names);
  std::cerr << "error: no plugin is called \"" << name << "\"; "
            << (near.empty() ? "`drape list` names them all" : "did you mean \"" + near + "\"?") << "\n";
  return exit_bad_input;
}

/// Writes the parameters of every plugin that has one into FOLDER/KIND/NAME/README.md.
int reference_into(const std::filesystem::path& folder, const Registry& registry) {
  int pages = 0;
  for (const auto& entry : registry.entries()) {
    const std::filesystem::path file = folder / entry->kind / entry->name / "README.md";
    std::ifstream in(file, std::ios::binary);
    if (!in) continue;
    const std::string page(std::istreambuf_iterator<char>(in), {});
    write_atomically(file, with_parameters(page, *entry));
    ++pages;
  }
  if (pages == 0)
    throw std::runtime_error("--readmes " + folder.string() +
                             ": no KIND/NAME/README.md of a plugin there; give the folder `plugins`");
  std::cout << pages << " pages written\n";
  return 0;
}

int reference(const Registry& registry) {
  std::cout << "# Configuration reference\n\nMade by `drape reference`; do not edit.\n\n## Experiment\n\n"
            << describe_markdown(schema_of<ExperimentParameters>("experiment"));
  for (const char* kind : kinds) {
    std::cout << "\n## Kind: " << kind << "\n";
    for (const RegistryEntry* entry : registry.of_kind(kind)) std::cout << "\n" << describe_markdown(*entry);
  }
  std::cout << "\n## Sweep\n\n" << describe_sweep_markdown();
  return 0;
}

int report(const std::vector<std::filesystem::path>& folders, std::filesystem::path page) {
  const bool several = folders.size() > 1 || is_sweep(folders.front());
  if (!several && !page.empty())
    throw std::runtime_error(
        "--out is for the page of several runs; a run's own is report.html in its folder");
  if (page.empty()) page = folders.front() / "report.html";
  if (folders.size() > 1 && page == folders.front() / "report.html")
    throw std::runtime_error("several folders: name the page with --out, as in --out results/together.html");
  if (several)
    write_runs_report(folders, page);
  else
    write_report(folders.front());
  std::cout << "report: " << page.string() << "\n";
  return 0;
}

void require_command(const CLI::App& app, const std::string& word) {
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == word) return;
    if (!command->get_group().empty()) commands.push_back(command->get_name());
  }
  const std::string near = nearest_word(word, commands);
  throw std::runtime_error(
      "there is no command \"" + word + "\"; " +
      (near.empty() ? "the commands are " + joined(commands) : "did you mean \"" + near + "\"?"));
}

int main_checked(int argc, char** argv) {
  CLI::App app("drape: progressive cloth quasistatics", "drape");
  app.set_version_flag("--version", [] { return "drape " + version() + " (" + commit() + ")"; });
  app.require_subcommand(1);
  app.failure_message([](const CLI::App* app, const CLI::Error& error) {
    const std::string command =
        app->get_subcommands().empty() ? "" : " " + app->get_subcommands()[0]->get_name();
    return std::string("error: ") + error.what() + "; see `drape" + command + " --help`\n";
  });

  ConfigArguments arguments;
  ResumeArguments resuming;
  ViewArguments showing;
  RunOptions options;
  std::string methods, out;
  int threads = 0;
  CLI::App* run_command = app.add_subcommand("run", "run an experiment and write its results and report");
  arguments.add_to(*run_command);
  arguments.config_option->required(false);
  run_command->add_option("--out", out, "results folder (default: results/NAME)");
  run_command->add_option("--method", options.methods, "only these of the experiment's methods")
      ->delimiter(',')
      ->allow_extra_args(false);
  run_command->add_option("--threads", threads, "threads (default: one a core)")->check(positive_integer);
  run_command->add_flag("--overwrite", options.overwrite,
                        "replace the results of an earlier run in the folder");
  resuming.add_to(*run_command);
  run_command
      ->add_option("--checkpoint", options.checkpoint,
                   "seconds between saved states, about (default 5; 0: one at every step)")
      ->check(CLI::NonNegativeNumber);
  run_command->add_flag("--quiet", options.quiet, "no progress on standard error");
  showing.add_to(*run_command);
  run_command->add_flag("!--no-report", options.report, "leave out report.html and its pictures");

  ConfigArguments check_arguments;
  CLI::App* check_command = app.add_subcommand("check", "check an experiment without running it");
  check_arguments.add_to(*check_command);

  const SweepCommand sweep(app);

  std::string kind, plugin, run_folder, schema_kind = "experiment";
  CLI::App* list_command = app.add_subcommand("list", "list what experiments can choose by name");
  list_command->add_option("kind", kind, "only this kind");
  CLI::App* describe_command =
      app.add_subcommand("describe", "show a plugin's parameters (or `experiment`'s, `sweep`'s)");
  describe_command->add_option("plugin", plugin, "name of the plugin")->required();
  std::vector<std::string> report_folders, compared, bounds, columns;
  TableFormat format = TableFormat::markdown;
  CLI::App* report_command =
      app.add_subcommand("report", "write the report of a run again, or one of several runs or of a sweep");
  report_command->add_option("folder", report_folders, "results folders, or a sweep's")->required();
  report_command->add_option("--out", out, "page of several runs (default: report.html in a sweep's folder)");
  CLI::App* compare_command = app.add_subcommand(
      "compare", "say what got faster, slower, better or worse from one run or sweep to another");
  compare_command->add_option("runs", compared, "the one before and the one after")->required()->expected(2);
  compare_command
      ->add_option("--bound", bounds,
                   "exit with 1 when a figure is more than so many times what it was; may be repeated")
      ->type_name("KEY=RATIO")
      ->allow_extra_args(false);
  CLI::App* table_command = app.add_subcommand(
      "table",
      "print one table of runs and sweeps, a row a method of each; exits with 1 where one does not pass");
  table_command->add_option("folder", report_folders, "results folders, or sweeps'")->required();
  table_command->add_option("--format", format, "md, csv or json")
      ->transform(CLI::CheckedTransformer(std::map<std::string, TableFormat>{
          {"md", TableFormat::markdown}, {"csv", TableFormat::csv}, {"json", TableFormat::json}}));
  table_command->add_option("--columns", columns, "only these, in this order, as in run,outcome,energy")
      ->delimiter(',')
      ->allow_extra_args(false);
  CLI::App* table1_command =
      app.add_subcommand("table1", "print a run's consistency beside the supplement's Table 1");
  table1_command->add_option("folder", run_folder, "results folder")->required();
  CLI::App* schema_command =
      app.add_subcommand("schema", "print the JSON Schema of experiments (or sweeps), for editors");
  schema_command->add_option("kind", schema_kind, "experiment or sweep")
      ->check(CLI::IsMember({"experiment", "sweep"}));
  CLI::App* reference_command =
      app.add_subcommand("reference", "print the configuration reference (Markdown)");
  reference_command->add_option("--readmes", run_folder,
                                "instead, write each plugin's parameters into FOLDER/KIND/NAME/README.md");

  if (argc < 2) {
    std::cerr << app.help();
    return exit_bad_input;
  }
  if (argv[1][0] != '-') require_command(app, argv[1]);
  try {
    app.parse(argc, argv);
    if (*run_command && arguments.config.empty() && resuming.folder.empty())
      throw CLI::RequiredError(arguments.config_option->get_name());
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : exit_bad_input;
  }

  set_thread_count(threads);
  if (*report_command) {
    return report({report_folders.begin(), report_folders.end()}, out);
  }
  if (*compare_command) {
    const Comparison comparison(read_runs({compared[0]}), read_runs({compared[1]}), parse_bounds(bounds));
    std::cout << comparison.text();
    return comparison.broken() ? exit_bound_broken : 0;
  }
  if (*table_command) {
    const std::vector<TableRow> rows = table_rows(read_runs({report_folders.begin(), report_folders.end()}));
    std::cout << table_text(rows, columns, format);
    return all_pass(rows) ? 0 : exit_not_converged;
  }
  if (*table1_command) {
    std::cout << table1_text(read_run(run_folder));
    return 0;
  }
  if (sweep.job_chosen() || sweep.chosen()) stop_on_signals();
  const auto stop = [] { return int(stop_signal); };
  if (sweep.job_chosen()) return sweep.run_job(stop);
  Registry registry;
  load_plugins(registry, plugin_directories());
  options.out = out;
  if (*run_command) return run(resuming, arguments, showing, options, registry);
  if (sweep.chosen()) return sweep.run(registry, stop);
  if (*check_command) return check(check_arguments, registry);
  if (*list_command) return list(kind, registry);
  if (*describe_command) return describe_plugin(plugin, registry);
  if (*schema_command) {
    std::cout << (schema_kind == "sweep"
                      ? sweep_json_schema()
                      : json_schema(schema_of<ExperimentParameters>("experiment"), &registry))
                     .dump(2)
              << "\n";
    return 0;
  }
  if (*reference_command)
    return run_folder.empty() ? reference(registry) : reference_into(run_folder, registry);
  return exit_bad_input;
}

}  // namespace

namespace drape {

std::string positive_integer(const std::string& text) {
  const std::optional<int> number = parse_integer(text);
  return number && *number > 0 ? "" : "must be an integer of at least 1, not " + text;
}

}  // namespace drape

int main(int argc, char** argv) {
  try {
    return main_checked(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << "\n";
    return exit_bad_input;
  }
}
