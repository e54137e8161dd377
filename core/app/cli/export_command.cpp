#include "core/app/cli/export_command.h"

#include <cmath>
#include <iostream>
#include <optional>

#include "core/app/cli/config_arguments.h"
#include "core/app/cli/help.h"
#include "core/app/experiment/exit_codes.h"
#include "core/app/report/pictures.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

namespace {

/// The vector that "X,Y,Z" spells; nothing for another text, and for a vector whose length says no direction.
std::optional<Eigen::Vector3d> direction_of(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string& part : split(text, ',')) {
    const std::optional<double> number = parse_number(part);
    if (!number || !std::isfinite(*number)) return {};
    numbers.push_back(*number);
  }
  if (numbers.size() != 3) return {};
  const Eigen::Vector3d direction(numbers[0], numbers[1], numbers[2]);
  const double length = direction.norm();
  if (!(length > 1e-9 && length < 1e9)) return {};
  return direction;
}

std::string fault_of_direction(const std::string& text) {
  return direction_of(text) ? "" : "must be a direction, as in 1,-1,0.5, not " + excerpt(text);
}

std::string fault_of_width(const std::string& text) {
  const std::optional<int> number = parse_integer(text);
  return number && *number >= least_picture_width && *number <= greatest_picture_width
             ? ""
             : "must be " + std::to_string(least_picture_width) + " to " +
                   std::to_string(greatest_picture_width) + " pixels, not " + excerpt(text);
}

}  // namespace

void add_picture_width(CLI::App& command, std::optional<int>& width, const std::string& help) {
  command.add_option("--width", width, help)->check(fault_of_width)->type_name("PIXELS");
}

ExportCommand::ExportCommand(CLI::App& app)
    : command_(app.add_subcommand("export", "write states of a run as glTF, OBJ, PLY, VTP or PNG")) {
  show_example(*command_, "drape export results/sphere --to sphere.glb --frames");
  command_->add_option("folder", folder_, "results folder")->required();
  command_
      ->add_option("-o,--to", file_,
                   "file to write: .glb has every level as a scene, with the obstacles; .obj, .ply and .vtp "
                   "have the finest level's cloth; .png is a picture of the finest level")
      ->type_name("FILE")
      ->required();
  command_->add_option("--method", options_.method, "method (default: pcs, or the only one that was run)")
      ->type_name("NAME");
  command_->add_option("--level", options_.level, "this level only")
      ->type_name("N")
      ->check(number_of_at_least(0));
  command_->add_flag("--frames", options_.frames,
                     "with .glb: the recorded snapshots of one level (default: the finest) as an animation; "
                     "with .png: those of every level, coarse to fine, as numbered pictures");
  add_picture_width(*command_, options_.picture.width, "with .png: width in pixels (default: 1800)");
  command_
      ->add_option_function<std::string>(
          "--view", [this](const std::string& text) { options_.picture.direction = direction_of(text); },
          "with .png: direction towards the camera (default: that of the report's pictures)")
      ->check(fault_of_direction)
      ->type_name("X,Y,Z");
  command_->add_flag("--outline", options_.picture.outline,
                     "with .png: draw the outline of the method's coarsest state over the picture");
  command_->add_flag("--xray", options_.picture.xray,
                     "with .png: let obstacles show faintly through the cloth");
  command_->add_flag("--overwrite", options_.overwrite, "replace existing files");
}

int ExportCommand::run() const {
  const std::vector<std::filesystem::path> files = export_run(folder_, file_, options_);
  std::cout << "written: " << printable(files.front().string());
  if (files.size() > 1) std::cout << " to " << printable(files.back().string());
  std::cout << "\n";
  return exit_done;
}

}  // namespace drape
