#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/app/experiment/pattern_parameters.h"
#include "core/numerics/sewing/pattern.h"

namespace drape {

/// A node as a map: a bare list stands for the value of `key`.
inline ConfigNode with_key(const std::string& key, const ConfigNode& node) {
  if (node.kind != ConfigNode::Kind::list) return node;
  ConfigNode map;
  map.where = node.where;
  map.add(key, node);
  return map;
}

/// A list's items or a map's values, each with its name ("" in a list) and its place.
struct NamedNode {
  std::string name;
  const ConfigNode* node;
  Location where;
};
/// With an error for each name that is given twice, as "panel front".
std::vector<NamedNode> named_nodes(const ConfigNode& node, const std::string& kind, ConfigErrors& errors);

/// How the numbers of a pattern's file are meant.
struct PatternUnits {
  double length = 1;               ///< [m]
  bool relative_curvature = true;  ///< control points are relative to their edge
};

/// A panel with what seams need of it. An edge that has darts is several edges.
struct ReadPanel {
  Panel panel;
  std::vector<std::string> edge_names;     ///< as written; "" for one without a name
  std::map<std::string, int> named_edges;  ///< the first of each name
  std::vector<std::vector<int>> parts;     ///< of each written edge, its edges in the panel
  std::vector<std::pair<int, int>> darts;  ///< their two legs

  /// The number of a written edge that a node names, or nothing with an error that says what there is; `user`
  /// names what asks for it, as "seam waist".
  std::optional<int> edge_of(const ConfigNode& node, const std::string& user, ConfigErrors& errors) const;
};

/// Reads a panel; nothing, with located errors, unless its edges form closed loops.
std::optional<ReadPanel> read_panel(const std::string& name, const ConfigNode& node,
                                    const PatternUnits& units, ConfigErrors& errors);

}  // namespace drape
