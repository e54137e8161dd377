#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/kernel/plugin/config_node.h"
#include "core/kernel/plugin/declaration.h"

namespace drape {

/// The keys of a pattern's file, which is GarmentCode's JSON, or YAML of the same structure. Nodes are read
/// by pattern_file.cpp and panel_reader.cpp.

/// A fold of a panel that is sewn shut, a triangle that an edge loses.
struct DartParameters {
  ConfigNode edge;
  double at = 0.5, width = 0, depth = 0;
  static void declare(Declaration<DartParameters>& d);
};

struct CurvatureParameters {
  std::string type = "quadratic";
  ConfigNode params;
  static void declare(Declaration<CurvatureParameters>& d);
};

struct PanelEdgeParameters {
  ConfigNode endpoints, curvature;
  std::optional<std::string> name, label;
  static void declare(Declaration<PanelEdgeParameters>& d);
};

struct PanelParameters {
  Eigen::Vector3d translation{0, 0, 0}, rotation{0, 0, 0};
  double grain = 0;
  ConfigNode vertices, edges;
  std::vector<DartParameters> darts;
  std::optional<std::string> label;
  static void declare(Declaration<PanelParameters>& d);
};

struct PatternSeamParameters {
  std::optional<std::string> name;
  ConfigNode sides;
  std::optional<double> ease;
  bool right_wrong = false;
  static void declare(Declaration<PatternSeamParameters>& d);
};

struct PatternParameters {
  ConfigNode panels, stitches, panel_order;
  static void declare(Declaration<PatternParameters>& d);
};

struct PatternPropertyParameters {
  double units_in_meter = 1;
  std::string curvature_coords = "relative", up = "y";
  ConfigNode unread;
  static void declare(Declaration<PatternPropertyParameters>& d);
};

struct PatternFileParameters {
  PatternPropertyParameters properties;
  PatternParameters pattern;
  ConfigNode unread;
  static void declare(Declaration<PatternFileParameters>& d);
};

/// The tables of these keys for the reference page.
std::string describe_pattern_markdown();

}  // namespace drape
