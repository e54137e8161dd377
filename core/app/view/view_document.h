#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/app/files/json_file.h"
#include "core/app/view/surface_fields.h"

namespace drape {

/// Converts a cloth's levels, obstacles and states to the viewer's format: a JSON document and named blocks
/// of bytes that it refers to. The report embeds them, the live view serves them.
class ViewDocument {
 public:
  /// Receives a named block.
  using Keep = std::function<void(const std::string& name, std::string bytes)>;

  using Obstacles = std::vector<TriangleMesh>;

  /// `levels`, coarse to fine, and `obstacles` must outlive the document; gaps are shown `with_gaps`. States
  /// may have the fields `further` beside the derived ones.
  ViewDocument(const std::vector<Level>& levels, const Obstacles& obstacles, bool with_gaps, Keep keep,
               const std::vector<FieldKind>& further = {});

  // `moved`: the obstacles where that state has them; null for where the document has them.

  /// The fields that depend on positions, and contact forces: `pressure` is LevelModel::contact_pressure,
  /// empty where they are not known.
  SurfaceFields fields(int level, const Positions& x, const Eigen::VectorXd& pressure = {},
                       const Obstacles* moved = nullptr) const;
  /// Sets the colour ranges, which are empty at first, to those of the states, usually the last of each
  /// level; a field that no state has keeps its range. Returns whether one reaches beyond its old ends, at
  /// which states that were encoded before are cut off.
  bool set_ranges(const std::vector<const SurfaceFields*>& states);
  /// Encodes a state; its blocks are named after `name`.
  Json state(const std::string& name, const Positions& x, const SurfaceFields& fields,
             const Obstacles* moved = nullptr);

  /// The document, with `methods` as {"name", "levels": [{"level", "status", "states": [...]}]}.
  Json document(const std::string& title, Json methods) const;

 private:
  Json mesh_entry(const std::string& name, const Positions& x, const Triangles& triangles);
  void add_sewing(const Level& level, Json& entry);

  const std::vector<Level>& levels_;
  bool with_gaps_;
  double gap_range_;  // the range of displayed gaps: a fraction of the rest shape's diagonal [m]
  const Obstacles& obstacles_;
  Keep keep_;
  std::vector<FieldKind> kinds_;
  Json level_entries_ = Json::array(), obstacle_entries_ = Json::array();
};

// The viewer's blocks of bytes, little endian; docs/contributing/working.md says who packs and reads them.

/// Six float32, lower corner and size of the box, then x, y and z plane by plane as uint16 within it, each
/// the difference from the vertex before modulo 2^16. What is not finite becomes the lower corner.
std::string encode_positions(const Positions& x);

/// Plane by plane, each corner as an int32 difference from the triangle before.
std::string encode_triangles(const Triangles& triangles);

/// Two float32, low and high, then a uint8 a value: 0 … 254 within them, ends included, 255 for NaN.
std::string encode_scalars(const Eigen::VectorXd& values, double low, double high);

/// In zlib's format, which browsers call "deflate".
std::string deflated(std::string_view bytes);

/// Appends each block to a page's `blocks` as a <script> element.
ViewDocument::Keep embedded_in(std::string& blocks);

}  // namespace drape
