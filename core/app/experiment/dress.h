#pragma once

#include <string>
#include <vector>

#include "core/kernel/plugin/config_node.h"
#include "core/kernel/plugin/declaration.h"
#include "core/numerics/mesh_files/file_coordinates.h"

namespace drape {

struct Experiment;
struct ScheduleKey;

/// A garment of flat pieces that is put on a body: the body grows inside the garment, which is then sewn, and
/// at last has weight and friction.
struct DressParameters : FileCoordinates {
  std::string body;  ///< a file, which apply_dress makes an obstacle; with its placement:
  double scale = 1;
  Eigen::Vector3d rotate{0, 0, 0}, translate{0, 0, 0};
  std::string obstacle;  ///< the body's name among the obstacles; empty without dressing
  int growth = 10, sewing = 30;
  double largest_stretch = 0.5;  ///< of a sewn garment, as Tightness::stretch
  int tightening = 0;            ///< increments in which strain limits come down; the schedule sets it
  // Set by the phases' schedule alone: the weight of the placed shape's metric in the pieces' rest shape,
  // from 0.99 to 0, and a factor on loads, from 0 to 1.
  double placed = 0, loads = 1;

  bool is_asked() const { return !obstacle.empty(); }
  static void declare(Declaration<DressParameters>& d);
};

/// Replaces `dress.body` of an experiment, with its placement, by an obstacle that `dress` names.
void apply_dress(ConfigNode& experiment, ConfigErrors& errors);

/// Makes the phases the schedule of an experiment that asks for `dress`, in increments of one unit of
/// pseudo-time: growth, sewing, the tightening of strain limits if there are any, then one with loads and
/// friction. Its first key is the body's contraction, whose values a scene finds. Appends errors for what
/// does not go with `dress`.
void make_dressing_schedule(Experiment& experiment, ConfigErrors& errors);

/// The phase that an increment of that schedule belongs to: "start", "growth", "sewing", "limit", "weight".
std::string dressing_phase(const DressParameters& dress, int increment);

}  // namespace drape
