#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/app/report/image.h"
#include "core/app/view/colours.h"
#include "core/kernel/mesh/triangle_mesh.h"

namespace drape {

/// The camera of a picture, as OpenGL matrices.
struct Camera {
  Eigen::Matrix4d view;        ///< world to eye
  Eigen::Matrix4d projection;  ///< eye to clip

  /// Perspective from `direction` (towards the camera), z up, as close as possible with all points in view.
  static Camera around(const std::vector<const Positions*>& states, const Eigen::Vector3d& direction,
                       double aspect);
  /// Orthographic, perpendicular to a nearly flat mesh.
  static Camera facing(const TriangleMesh& flat, double aspect);
};

/// Contents of a picture. Triangles with a vertex that is not finite are skipped.
struct Drawing {
  const TriangleMesh& mesh;
  const Positions* normals = nullptr;      ///< n×3 unit normals; otherwise the mesh's own smooth ones
  const Colours* colours = nullptr;        ///< n×3; otherwise plain cloth
  bool edges = false;                      ///< thin lines along the triangles' edges
  bool lit = true;                         ///< otherwise flat colours, for maps
  const TriangleMesh* obstacle = nullptr;  ///< drawn with it, plain and dark
};

/// All meshes as one.
TriangleMesh merged(const std::vector<TriangleMesh>& meshes);

/// n×3 unit normals, area-weighted; zero where undefined.
Positions smooth_normals(const TriangleMesh& mesh);

/// A Renderer stopped before its picture was finished.
struct PictureLeft : std::runtime_error {
  PictureLeft() : std::runtime_error("the picture was left unfinished") {}
};

/// Renders cloth off screen in software (OSMesa), without a display: a key light with shadow, a fill light,
/// and sky light with occlusion. One instance at a time, on one thread.
class Renderer {
 public:
  /// Size of the pictures [pixels]. `leave`, which may be empty, is polled while the sky light of a picture
  /// is computed. Throws std::runtime_error if OSMesa gives no context.
  Renderer(int width, int height, std::function<bool()> leave = {});
  ~Renderer();

  /// Throws PictureLeft once `leave` returns true.
  Image draw(const Drawing& drawing, const Camera& camera) const;

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

}  // namespace drape
