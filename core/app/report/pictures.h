#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/app/picture/render.h"
#include "core/app/report/run_data.h"

namespace drape {

/// Width of a run's pictures [pixels]: a report's unless another is asked for, and what may be asked for.
inline constexpr int default_picture_width = 900, least_picture_width = 16, greatest_picture_width = 8000;

/// How pictures of a run look; the defaults are a report's.
struct PictureOptions {
  std::optional<int> width = {};                  ///< [pixels]
  std::optional<Eigen::Vector3d> direction = {};  ///< towards the camera; of any length but 0
  bool outline = false;  ///< draw the outline of the method's coarsest state: for exports
  bool xray = false;     ///< let obstacles show faintly through the cloth
  bool edges = true;     ///< of coarse meshes
  Colours colours = {};
};

/// What a run's pictures have in common: its final states and obstacles, the floor, and one camera around
/// them all.
class PictureScene {
 public:
  /// Reads the states and obstacles of a run that outlives the scene; a mesh that cannot be read becomes a
  /// note. `further` are in view too. Once `cancelled`, which may be empty, returns true, drawing throws
  /// RenderingCancelled.
  PictureScene(const RunData& run, std::vector<std::string>& notes, const PictureOptions& options,
               const std::vector<const Positions*>& further = {}, std::function<bool()> cancelled = {});

  /// The final state of a level of the run; null without one.
  const TriangleMesh* state(const LevelRecord& level) const;

  /// Draws cloth among the obstacles, a coarse mesh with its edges.
  Image draw(const TriangleMesh& cloth) const;
  /// Draws the outline of a cloth over a picture of this scene.
  void draw_outline(Image& picture, const TriangleMesh& cloth) const;

 private:
  std::map<const LevelRecord*, TriangleMesh> states_;
  std::map<Eigen::Index, std::vector<unsigned char>> seams_;  // of each level, by its number of triangles
  std::vector<TriangleMesh> obstacles_;
  Camera camera_;
  std::optional<double> floor_;  // height below everything
  PictureOptions options_;
  int width_;  // [pixels]
  std::function<bool()> cancelled_;
};

/// All pictures of a run.
struct PictureSet {
  /// By file name in DIR/pictures, as the *_picture functions below give it.
  std::map<std::string, Image> pictures;
  /// For a page, of each method: its end with the outline of its preview, or its only state.
  Json ends = Json::array();
  std::vector<std::string> notes;  ///< pictures that could not be drawn, one line each
};

std::string state_picture(const MethodRecord& method, int level);
std::string outline_picture(const MethodRecord& method, int coarse, int fine);

/// Draws all pictures of a run, `width` (default: 900) pixels wide, and writes them to DIR/pictures: each
/// state, and each method's finest with the outline of its coarsest. A missing or unreadable mesh becomes a
/// note. Once `cancelled` (may be empty) returns true, it skips the remaining pictures, with a note. Throws
/// std::runtime_error if the folder is not writable.
PictureSet draw_pictures(const RunData& run, const std::function<bool()>& cancelled = {},
                         std::optional<int> width = {});

}  // namespace drape
