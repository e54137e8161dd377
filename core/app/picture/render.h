#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// A picture in memory: rows from the top, three bytes (red, green, blue; sRGB) a pixel.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<unsigned char> pixels;  ///< 3·width·height
};

/// The bytes of a PNG file. Throws std::runtime_error if libpng refuses the image.
std::string encode_png(const Image& image);

/// The camera of a picture.
struct Camera {
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  ///< rows: right, up and towards the camera
  Eigen::Vector3d eye = Eigen::Vector3d::UnitZ();       ///< in that frame [m]
  Eigen::Vector2d tangent = {1, 1};                     ///< of half the angle of view, across and up

  /// Perspective from `direction` (towards the camera), z up, or y up along z, as close as possible with all
  /// points in view.
  static Camera around(const std::vector<const Positions*>& states, const Eigen::Vector3d& direction,
                       double aspect);
};

/// Colours of a picture.
struct Colours {
  std::optional<Eigen::Vector3f> cloth = {};  ///< of its front, sRGB in [0, 1]; the back is paler
  bool dark = false;                          ///< the backdrop
};

/// Contents of a picture. Triangles with a vertex that is not finite are skipped.
struct Drawing {
  const TriangleMesh& mesh;
  bool edges = false;  ///< thin lines along the triangles' edges
  /// Broader lines along seams: of each triangle the sum of 2^k over its sides opposite corners k that are;
  /// or empty.
  std::vector<unsigned char> seams = {};
  bool xray = false;                                ///< cloth in front of an obstacle lets it show faintly
  std::vector<const TriangleMesh*> obstacles = {};  ///< dark
  std::optional<double> floor = {};                 ///< height of a floor that shows shadows only [m]
  Colours colours = {};
};

/// `render` was cancelled before its picture was finished.
struct RenderingCancelled : std::runtime_error {
  RenderingCancelled() : std::runtime_error("the picture was cancelled") {}
};

/// Traces rays (Embree) on thread_count() threads: a wide key light with soft shadows, a fill light, and sky
/// light with occlusion. The same drawing gives the same bits with any number of threads. `cancelled`, which
/// may be empty, is polled between rows, on the thread that draws. Throws RenderingCancelled once it returns
/// true, std::runtime_error if Embree fails.
Image render(const Drawing& drawing, const Camera& camera, int width, int height,
             const std::function<bool()>& cancelled = {});

/// Draws the outline of a mesh over a finished picture, as the picture's camera sees the mesh with nothing in
/// front: a soft line, 0.3 % of the picture's height wide and at least 1.5 pixels. `colour`: sRGB in [0, 1].
/// Any number of threads gives the same bits. Throws std::runtime_error if Embree fails.
void draw_outline(Image& image, const TriangleMesh& mesh, const Camera& camera,
                  const Eigen::Vector3f& colour);

}  // namespace drape
