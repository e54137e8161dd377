#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/kernel/plugin/config_node.h"
#include "core/kernel/plugin/declaration.h"
#include "core/numerics/mesh_files/file_coordinates.h"

namespace drape {

struct Experiment;

/// A garment of flat pieces that is put on a body: the body grows inside the garment, which is then sewn, and
/// at last has weight.
struct DressParameters : FileCoordinates {
  std::string body;  ///< a file, which apply_dress makes an obstacle; with its placement:
  double scale = 1;
  Eigen::Vector3d rotate{0, 0, 0}, translate{0, 0, 0};
  std::string obstacle;  ///< the body's name among the obstacles; empty without dressing
  int growth = 10, sewing = 30;
  std::optional<double> friction;         ///< while the body grows and the garment is sewn
  std::optional<double> largest_stretch;  ///< of a sewn garment, as Tightness::stretch
  bool worn = false;  ///< refuse a garment with an opening that no part of the body passes through

  bool is_asked() const { return !obstacle.empty(); }
  static void declare(Declaration<DressParameters>& d);
};

/// Replaces `dress.body` of an experiment, with its placement, by an obstacle that `dress` names.
void apply_dress(ConfigNode& experiment, ConfigErrors& errors);

/// Appends errors for what does not go with `dress`; the plugins must have been made.
void check_dress(const Experiment& experiment, ConfigErrors& errors);

}  // namespace drape
