#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/app/picture/render.h"
#include "core/app/report/run_data.h"

namespace drape {

/// Width of a run's pictures [pixels]: a report's unless another is asked for, and what may be asked for.
inline constexpr int default_picture_width = 900, least_picture_width = 16, greatest_picture_width = 8000;
/// Height of a picture of that width [pixels].
int picture_height(int width);

/// A mesh of the run's folder. Throws std::runtime_error if it cannot be read, or if a triangle names a
/// vertex that is not there.
TriangleMesh run_mesh(const RunData& run, const std::string& name);
/// The same; empty if there is no such file, and with a note if it cannot be read.
std::optional<TriangleMesh> try_run_mesh(const RunData& run, const std::string& name,
                                         std::vector<std::string>& notes);

/// Plain cloth as a picture of a state shows it: a coarse mesh with its edges.
Drawing plain_cloth(const TriangleMesh& state);

/// The colour of outlines, sRGB in [0, 1]: `--accent` of a report's page.
Eigen::Vector3f outline_colour();

/// From where pictures of a run are taken.
struct PictureFrame {
  /// Towards the camera: three quarters from above. The top shows how the cloth lies, the side how it folds.
  Eigen::Vector3d direction{0.55, -1.0, 0.68};
  int width = default_picture_width;           ///< [pixels]
  std::vector<const Positions*> further = {};  ///< in view, beside the run's final states
};

/// What a run's pictures have in common: its final states and obstacles, the floor, and one camera around
/// them all.
class PictureScene {
 public:
  /// Reads the states and obstacles; a mesh that cannot be read becomes a note.
  PictureScene(const RunData& run, std::vector<std::string>& notes, const PictureFrame& frame = {});

  /// The final state of a level; null without one.
  const TriangleMesh* state(const std::string& method, int level) const;
  /// Triangles of a level with so many vertices; null without one.
  const Triangles* triangles_of(Eigen::Index vertex_count) const;
  const Camera& camera() const { return camera_; }

  /// Draws cloth among the obstacles. Throws RenderingCancelled.
  Image draw(const Renderer& renderer, Drawing drawing) const;

 private:
  std::map<std::pair<std::string, int>, TriangleMesh> states_;  // by method and level
  TriangleMesh obstacle_;
  Camera camera_;
  std::optional<double> floor_;  // height below everything
};

}  // namespace drape
