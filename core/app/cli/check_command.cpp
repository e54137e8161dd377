#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/app/cli/commands.h"
#include "core/app/cli/config_arguments.h"
#include "core/app/experiment/exit_codes.h"
#include "core/app/files/machine.h"
#include "core/app/files/yaml_file.h"
#include "core/app/scene/scene_summary.h"
#include "core/app/setup/build_scene.h"
#include "core/app/sweep/sweep.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/plugin/make.h"
#include "core/numerics/mesh/seams.h"
#include "core/numerics/model/derivative_check.h"
#include "core/numerics/model/smoothness_check.h"

namespace drape {

namespace {

constexpr double bytes_of_triangle = 500;  // of an obstacle, as measured on spheres of 0.3 to 5 million

/// Lines on what an energy does to a small flat piece of cloth that no fabric does; none of one that refuses
/// the piece, as an energy that names vertices.
std::vector<std::string> remarks_of_piece(const Energy& energy, const Material& material) {
  std::vector<std::string> lines;
  try {
    const std::string jump = jump_of(energy, material);
    if (!jump.empty()) lines.push_back("NOT SMOOTH: " + jump);
    const bool elastic = Roles{EnergyRole::membrane, EnergyRole::bending}.has(energy.role());
    const double at_rest = elastic ? relative_force_at_rest(energy, material) : 0;
    if (at_rest > 1e-6)
      lines.push_back("its forces on the rest shape are not zero, but " + three_digits(at_rest) +
                      " of those at strains of 0.05: the cloth deforms without a load");
  } catch (const std::exception&) {
  }
  return lines;
}

/// "388 vertices, 1,093 edges, smallest angle 27°, 78 vertices on borders and seams" of a coarsened level.
std::string text_of(const Level& level) {
  double smallest = std::numbers::pi;
  for (int t = 0; t < level.triangle_count(); ++t) {
    const Eigen::Matrix3d x = rest_corners(level.rest, t);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d a = x.col((k + 1) % 3) - x.col(k), b = x.col((k + 2) % 3) - x.col(k);
      smallest = std::min(smallest, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  }
  std::set<int> outline;
  for (int e = 0; e < level.topology.edges.rows(); ++e)
    if (level.topology.edge_triangles(e, 1) == -1 || is_seam(level.rest, level.topology, e))
      for (const int v : level.topology.edges.row(e)) outline.insert(v);
  return std::to_string(level.vertex_count()) + " vertices, " + std::to_string(level.topology.edges.rows()) +
         " edges, smallest angle " + fixed_text(smallest * 180 / std::numbers::pi, 0) + "°, " +
         std::to_string(outline.size()) + " vertices on borders and seams";
}

int check_experiment(const ConfigArguments& arguments, const Registry& registry) {
  const LoadedExperiment loaded(arguments, registry);
  ConfigErrors errors;
  refuse_infinite_energies(loaded.experiment, *loaded.scene, errors);
  require_none(errors);
  std::cout << printable(arguments.config) << ": valid.";
  for (const Level& level : loaded.scene->hierarchy.levels)
    std::cout << (level.index ? ", " : " Vertices by level: ") << level.vertex_count();
  std::cout << "\nMemory to solve them, at most about:";
  for (const Level& level : loaded.scene->hierarchy.levels)
    std::cout << (level.index ? ", " : " ")
              << memory_text(estimated_memory(level.vertex_count()) +
                             bytes_of_triangle * loaded.summary.obstacle_triangles);
  std::cout << "; this machine has " << memory_text(machine_memory()) << "\n";
  if (estimated_seconds(loaded.summary, 1)) {
    std::cout << "Time until the end of each, by pcs on one core of " << estimate_processor
              << ", within about a factor of 3:";
    for (const Level& level : loaded.scene->hierarchy.levels)
      std::cout << (level.index ? ", " : " ")
                << rounded_text(*estimated_seconds(loaded.summary, level.vertex_count()), 2) << " s";
    std::cout << "\n";
  }
  std::cout << "Read: " << printable(text_of(loaded.summary)) << "\n";
  for (const Level& level : loaded.scene->hierarchy.levels)
    if (!level.cloth_vertices.empty())
      std::cout << "level " << level.index << " under the cloth's mesh: " << text_of(level) << "\n";
  for (const std::string& line : remarks_of(loaded.experiment, *loaded.scene))
    std::cout << printable(line) << "\n";
  const Material& material = loaded.experiment.parameters.material;
  for (const NamedEnergy& e : loaded.experiment.energies) {
    std::vector<std::string> lines = e.energy->remarks(material);
    for (std::string& line : remarks_of_piece(*e.energy, material)) lines.push_back(std::move(line));
    for (const std::string& line : lines) std::cout << printable(e.name + ": " + line) << "\n";
  }
  return exit_done;
}

/// Appends the faults of a run of a sweep, each named after its variation.
void check_run(const SweepRun& run, const Location& where, LargeMemory large, const Registry& registry,
               ConfigErrors& errors) {
  ConfigErrors faults;
  const auto experiment =
      read_experiment(parse_yaml(run.config, run.folder, faults), registry, faults, large);
  const auto scene = experiment ? build_scene(*experiment, faults, large) : nullptr;
  if (scene) refuse_infinite_energies(*experiment, *scene, faults);
  for (const ConfigError& fault : faults)
    errors.push_back({where, "variation \"" + run.name + "\": " + fault.message});
}

int check_sweep(const ConfigArguments& arguments, const Registry& registry) {
  const std::string& file = arguments.config;
  if (!arguments.sets.empty() || arguments.levels > 0 || arguments.allow_start_repair)
    throw std::runtime_error(file +
                             " is a sweep: leave out --set, --levels and --allow-start-repair, and "
                             "change what it sets in the file");
  ConfigErrors errors;
  const std::optional<Sweep> sweep = read_sweep(file, registry, errors);
  require_none(errors);
  std::set<std::string> variations;
  for (const SweepRun& run : sweep->runs)
    if (variations.insert(run.name).second && run.expect.status != "refused")
      check_run(run, {file}, arguments.large_memory(), registry, errors);
  require_none(errors);
  const std::size_t runs = sweep->runs.size(), seeds = runs / variations.size();
  std::cout << printable(file) << ": valid. A sweep of " << runs << (runs == 1 ? " run: " : " runs: ")
            << variations.size() << (variations.size() == 1 ? " variation, " : " variations, ") << seeds
            << (seeds == 1 ? " seed" : " seeds") << " each. `drape sweep " << printable(file)
            << "` runs it.\n";
  return exit_done;
}

int check_energy(const std::string& energy, const Registry& registry) {
  ConfigErrors errors;
  const std::optional<ConfigNode> node = value_of_option(energy, "energy", errors);
  const auto made = node ? make_from<Energy>(registry, *node, errors) : nullptr;
  require_none(errors);
  const DerivativeCheck check = check_derivatives(*made, Material());
  std::cout << printable_lines(check.text()) << "derivatives "
            << (check.agrees() ? "agree with" : "DIFFER from") << " finite differences\n";
  const std::string jump = jump_of(*made, Material());
  if (!jump.empty()) std::cout << "NOT SMOOTH: " << printable(jump) << "\n";
  return check.agrees() && jump.empty() ? exit_done : exit_not_converged;
}

}  // namespace

void add_check_commands(Commands& commands) {
  const auto arguments = std::make_shared<ConfigArguments>();
  arguments->add_to(commands.add_with_plugins(
      "check", "check an experiment or a sweep without running it",
      "drape check configs/sphere.yaml --set newton.step_size=0.1", [arguments](const Registry& registry) {
        ConfigErrors unread;
        return is_sweep_source(read_yaml(arguments->config, unread)) ? check_sweep(*arguments, registry)
                                                                     : check_experiment(*arguments, registry);
      }));
  const auto energy = std::make_shared<std::string>();
  commands
      .add_with_plugins("check-energy", "compare an energy's derivatives with finite differences",
                        "drape check-energy neo_hookean",
                        [energy](const Registry& registry) { return check_energy(*energy, registry); })
      .add_option("energy", *energy,
                  "name of the energy, or a map with its type and parameters as in an experiment")
      ->required();
}

}  // namespace drape
