#include <array>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>

#include "core/app/cli/commands.h"
#include "core/app/cli/config_arguments.h"
#include "core/app/experiment/exit_codes.h"
#include "core/app/experiment/experiment.h"
#include "core/app/experiment/fabrics.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/elements/orthotropic_stiffness.h"

namespace drape {
namespace {

/// A quantity along warp, weft and the bias.
using Directions = std::array<double, 3>;

Directions strips(const OrthotropicStiffness& stiffness) {
  return {stiffness.strip(0), stiffness.strip(std::numbers::pi / 2), stiffness.strip(std::numbers::pi / 4)};
}

void print_row(const std::string& label, const Directions& values, double unit,
               const std::string& unit_name) {
  std::cout << padded(label, 22);
  for (const double value : values) std::cout << std::setw(11) << general_text(value / unit, 4);
  std::cout << "  " << unit_name << "\n";
}

constexpr const char* assumed = " (default, not measured)";

/// The columns of a stiffness that were not measured, below its rows; nothing if all were.
void print_assumed(const std::optional<double>& weft, const std::optional<double>& bias) {
  if (weft && bias) return;
  std::cout << padded("", 22)
            << (weft   ? "bias"
                : bias ? "weft"
                       : "weft and bias")
            << " not measured: as of an isotropic cloth\n";
}

void print_sheet(const Material& material, const ConfigNode& figures) {
  const Directions bending = strips(plate_stiffness(material));
  const double weight = material.area_density() * standard_gravity;
  Directions length;
  for (std::size_t i = 0; i < 3; ++i) length[i] = std::cbrt(bending[i] / weight);
  std::cout << padded("mass", 22) << 1e3 * material.area_density() << " g/m²\n"
            << padded("thickness", 22) << 1e3 * material.thickness << " mm"
            << (figures.find("thickness") ? "" : assumed) << "\n"
            << padded("", 22) << "       warp       weft       bias\n";
  print_row("bending length c", length, 1e-3, "mm (ASTM D1388, BS 3356, FAST-2)");
  print_row("overhang at 41.5°", length, 0.5e-3, "mm");
  print_row("flexural rigidity G", bending, standard_gravity * 1e-8, "mg cm");
  print_row("bending rigidity B", bending, 1e-6, "µN m (FAST-2)");
  print_row("", bending, standard_gravity * 1e-5, "gf cm²/cm (KES-FB2)");
  if (material.warp_bending) print_assumed(material.weft_bending, material.bias_bending);
  if (material.bending_hysteresis > 0)
    std::cout << padded("hysteresis 2HB", 22) << 1e3 * material.bending_hysteresis << " mN, "
              << material.bending_hysteresis / (standard_gravity * 1e-3) << " gf cm/cm (KES-FB2)\n";
  const bool stretched = figures.find("membrane_modulus") || material.warp_stiffness;
  print_row("tensile stiffness", strips(membrane_stiffness(material)), 1,
            std::string("N/m") + (stretched ? "" : assumed));
  if (material.warp_stiffness) print_assumed(material.weft_stiffness, material.shear_stiffness);
}

struct FabricOptions {
  std::string name, file;
};

int print_fabric(const FabricOptions& options) {
  if (options.name.empty()) {
    if (!options.file.empty()) {
      for (const std::string& name : fabric_names(options.file)) std::cout << printable(name) << "\n";
      return exit_done;
    }
    for (const std::string& name : fabric_names()) {
      ConfigErrors none;
      std::cout << padded(name, 22)
                << fabric_row(ConfigNode::of(name), std::nullopt, none).find("source")->scalar << "\n";
    }
    return exit_done;
  }
  ConfigNode fabric = ConfigNode::of(options.name), row;
  if (!options.file.empty()) {
    row.add("file", ConfigNode::of(options.file));
    row.add("row", fabric);
    fabric = row;
  }
  ConfigErrors errors;
  const ConfigNode values = fabric_row(fabric, std::nullopt, errors);
  ConfigNode experiment(ConfigNode::Kind::map), material(ConfigNode::Kind::map);
  for (const auto& [key, value] : values.entries)
    if (key != "source") material.add(key, value);
  experiment.add("material", std::move(material));
  for (const char* required : {"name", "methods"}) experiment.add(required, ConfigNode::of(options.name));
  experiment.add("energies", ConfigNode(ConfigNode::Kind::list));
  Experiment own;
  own.source = std::move(experiment);
  if (errors.empty()) own.parameters = parameters_of(own.source, errors);
  if (errors.empty()) check_material(own, errors);
  require_none(errors);
  std::cout << printable(options.name);
  if (const ConfigNode* source = values.find("source")) std::cout << ": " << printable(source->scalar);
  std::cout << "\n";
  print_sheet(own.parameters.material, values);
  const std::string value = printable(options.file.empty() ? options.name : fabric.one_line());
  std::cout << "Where a figure is not known, the material's default stands for it: material: {fabric: "
            << value << "}\nDrape coefficient, by simulation: drape run configs/tests/cusick.yaml --set "
            << shell_quoted("material.fabric=" + value) << "\n";
  return exit_done;
}

}  // namespace

void add_fabric_command(Commands& commands) {
  const auto options = std::make_shared<FabricOptions>();
  CLI::App& command = commands.add("fabric", "print what a laboratory would measure of a fabric",
                                   "drape fabric gray-interlock", [=] { return print_fabric(*options); });
  command.add_option("name", options->name,
                     "a fabric of the table, or a row of FILE; without it, all are listed");
  add_option(command, "--file FILE", options->file, "a CSV file of your own");
}

}  // namespace drape
