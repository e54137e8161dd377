#include "core/app/cli/export_command.h"

#include <iostream>

#include "core/app/cli/help.h"
#include "core/app/experiment/exit_codes.h"
#include "core/kernel/mesh/message_text.h"

namespace drape {

ExportCommand::ExportCommand(CLI::App& app)
    : command_(app.add_subcommand("export", "write states of a run as glTF, OBJ, PLY or VTP")) {
  show_example(*command_, "drape export results/sphere --to sphere.glb --frames");
  command_->add_option("folder", folder_, "results folder")->required();
  command_
      ->add_option("-o,--to", file_,
                   "file to write: .glb has every level as a scene, with the obstacles; .obj, .ply and .vtp "
                   "have the finest level's cloth")
      ->required();
  command_->add_option("--method", options_.method, "method (default: pcs, or the only one that was run)");
  command_->add_option("--level", options_.level, "this level only")->check(CLI::NonNegativeNumber);
  command_->add_flag("--frames", options_.frames,
                     "with .glb: the recorded snapshots of one level (default: the finest) as an animation");
}

int ExportCommand::run() const {
  export_run(folder_, file_, options_);
  std::cout << "written: " << printable(file_) << "\n";
  return exit_done;
}

}  // namespace drape
