#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/app/picture/render.h"
#include "core/app/report/pictures.h"

namespace drape {

/// What a run's pictures share: its states and obstacles, one camera around them all, the renderers, and the
/// set that takes the pictures.
class PictureCanvas {
 public:
  /// Reads the states and obstacles; a mesh that cannot be read becomes a note. `run`, `leave` and `set` must
  /// outlive the canvas.
  PictureCanvas(const RunData& run, const std::function<bool()>& leave, PictureSet& set);

  /// A mesh of the run's folder; empty if there is none, with a note if it cannot be read.
  std::optional<TriangleMesh> try_mesh(const std::string& name);
  /// The final state of a level; null without one.
  const TriangleMesh* state(const std::string& method, int level) const;
  /// Triangles of a level with so many vertices; null without one.
  const Triangles* triangles_of(Eigen::Index vertex_count) const;

  /// Draws cloth and obstacles with the common camera and stores the picture. Throws PictureLeft.
  void draw(const std::string& name, Drawing drawing);
  /// Draws a flat mesh in flat colours, seen from above, and stores the picture. Throws PictureLeft.
  void draw_map(const std::string& name, const TriangleMesh& flat, const Colours& colours);

 private:
  void keep(const std::string& name, Image image);

  const RunData& run_;
  const std::function<bool()>& leave_;
  PictureSet& set_;
  std::map<std::pair<std::string, int>, TriangleMesh> states_;  // by method and level
  TriangleMesh obstacle_;
  Camera camera_;
  std::optional<double> floor_;  // height below everything
  std::unique_ptr<Renderer> renderer_, map_renderer_;
};

}  // namespace drape
