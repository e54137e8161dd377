#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <system_error>

#include "core/app/cli/commands.h"
#include "core/app/experiment/exit_codes.h"
#include "core/app/experiment/experiment.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"

namespace drape {

namespace {

/// The experiment, less its name.
constexpr const char* first_experiment = R"yaml(
# The coarsest mesh: a flat pattern (square, rectangle, disc, polygon), or `shape: file` with `file: mesh.obj`, and with
# `unit: mm` and `up: y` if the file is not in metres with z up.
cloth: {shape: square, side: 1, vertices: 900}

# Every level has four times the triangles of the one before: 900, 3.5K and 14K vertices here.
levels: 3

# Cotton. Density and thickness together give the mass of an area; the moduli are Young's for stretching and
# for bending.
material:
  density: 472.6           # [kg/m³]
  thickness: 3.18e-4       # [m]
  membrane_modulus: 8e4    # [Pa]
  bending_modulus: 8e5     # [Pa]
  poisson_ratio: 0.243

# The cloth begins here: flat, centred above the sphere, with a millimetre of noise so that it may fold.
start: {translate: [-0.5, -0.5, 0.32], perturbation: 1e-3}

# Corners that stay where they are:
# pins:
#   - {region: nearest, point: [0, 0, 0]}
#   - {region: nearest, point: [1, 0, 0]}

# `drape list energy` names every energy, `drape describe strain_limit` shows one's parameters.
energies: [neo_hookean, hinge, {type: strain_limit, limit: 1.06}, gravity]

# `ipc` keeps the cloth apart from itself and from meshes, `shapes` from solids such as this sphere at the origin.
contact: [ipc, shapes]
obstacles: [{name: ball, shape: sphere, radius: 0.3, translate: [0, 0, 0]}]
friction: 0.1              # Coulomb's coefficient, with the cloth itself and with every obstacle

# A level ends once its forces balance to this fraction.
newton: {force_tolerance: 1e-3}

# Progressive cloth quasistatics. To compare it with the cascadic method and with direct solves, take
# the two comments away and run with --method all.
methods:
  pcs: {}
  # cascadic: {}
  # newton: {}
)yaml";

std::string text_of(const std::string& file, const std::string& name) {
  const std::string results = "results/" + name;
  return "# A square of cotton is draped over a sphere. Lengths are in metres, masses in kilograms, times in "
         "seconds; z\n"
         "# points up. `drape describe experiment` lists every key with its unit, range and default.\n"
         "#\n"
         "#   drape check " +
         file +
         "    checks this file without running it\n"
         "#   drape run " +
         file + "      runs it; results and report.html go to " + results +
         "\n"
         "#   drape view " +
         results +
         "    opens the report, with the cloth in 3D\n"
         "name: \"" +
         name + "\"\n" + first_experiment;
}

/// Throws std::runtime_error if the file exists, or cannot be made, or its name cannot be an experiment's.
int write_first_experiment(std::filesystem::path file) {
  if (file.extension() != ".yaml" && file.extension() != ".yml") file += ".yaml";
  const std::string name = file.stem().string();
  ConfigErrors errors;
  check_name("the experiment's name", name, {}, errors);
  if (!errors.empty()) throw std::runtime_error(errors[0].message);
  std::error_code unknown;
  if (std::filesystem::exists(std::filesystem::symlink_status(file, unknown)))
    throw std::runtime_error(printable(file.string()) +
                             ": exists already; name another file, as in drape new " + printable(name) +
                             "_2.yaml");
  try {
    write_file(file, text_of(file.string(), name), Existing::kept);
  } catch (const WriteError& error) {
    throw std::runtime_error(error.what());  // a refusal: no run was begun
  }
  std::cout << "written: " << printable(file.string()) << "\nnext: drape run " << printable(file.string())
            << "\n";
  return exit_done;
}

}  // namespace

void add_new_command(Commands& commands) {
  const auto file = std::make_shared<std::string>("first.yaml");
  commands
      .add("new", "write a commented first experiment", "drape new scarf.yaml",
           [file] { return write_first_experiment(*file); })
      .add_option("file", *file, "file to write, which must not exist (default: first.yaml)");
}

}  // namespace drape
