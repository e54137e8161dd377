#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/report/image.h"

namespace drape {

/// n×3 vertex colours: red, green, blue in [0, 1], sRGB.
using Colours = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Where a picture is taken from. Plain matrices, as OpenGL has them.
struct Camera {
  Eigen::Matrix4d view;        ///< world to eye
  Eigen::Matrix4d projection;  ///< eye to clip

  /// In perspective from `direction` (towards the camera), z up, as near as all points stay in view.
  static Camera around(const std::vector<const Positions*>& states, const Eigen::Vector3d& direction,
                       double aspect);
  /// Without perspective, at right angles to a nearly flat mesh.
  static Camera facing(const TriangleMesh& flat, double aspect);
};

/// What a picture shows. Triangles with a vertex that is not finite are left out.
struct Drawing {
  const TriangleMesh& mesh;
  const Positions* normals = nullptr;      ///< n×3 unit normals; otherwise the mesh's own smooth ones
  const Colours* colours = nullptr;        ///< n×3; otherwise plain cloth
  bool edges = false;                      ///< thin lines along the triangles' edges
  bool lit = true;                         ///< otherwise flat colours, for maps
  const TriangleMesh* obstacle = nullptr;  ///< drawn with it, plain and dark
};

/// All of them as one.
TriangleMesh merged(const std::vector<TriangleMesh>& meshes);

/// n×3 unit normals, area-weighted; zero where undefined.
Positions smooth_normals(const TriangleMesh& mesh);

/// A picture that its Renderer was told to leave unfinished.
struct PictureLeft : std::runtime_error {
  PictureLeft() : std::runtime_error("the picture was left unfinished") {}
};

/// Draws cloth off screen, in software (OSMesa): a warm key light with its shadow, a fill, and sky light
/// with occlusion. No display is needed. One at a time, on one thread.
class Renderer {
 public:
  /// Size of the pictures [pixels]. `leave`, which may be empty, is asked while the sky light of a
  /// picture is made. Throws std::runtime_error if OSMesa gives no context.
  Renderer(int width, int height, std::function<bool()> leave = {});
  ~Renderer();

  /// Throws PictureLeft once `leave` says so.
  Image draw(const Drawing& drawing, const Camera& camera) const;

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

}  // namespace drape
