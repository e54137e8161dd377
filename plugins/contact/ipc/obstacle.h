#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/numerics/collision_detection/obstacle_surface.h"
#include "core/numerics/contact/contact_parameters.h"
#include "core/numerics/mesh/rotation.h"
#include "core/numerics/mesh_files/file_coordinates.h"
#include "plugins/contact/ipc/cages.h"
#include "plugins/contact/ipc/validated_mesh.h"

namespace drape::ipc {

/// One obstacle in a config: a mesh and its transform. Exactly one of `mesh`, `meshed_shape` and `animation`
/// says which mesh. Files are read by the FileCoordinates.
struct ObstacleParameters : CommonObstacleParameters, FileCoordinates {
  std::string mesh;                         ///< a file
  std::optional<std::string> meshed_shape;  ///< "box" or "sphere"
  Eigen::Vector3d size{1, 1, 1};
  double radius = 0.5;
  int subdivisions = 4;
  std::vector<std::string> animation;
  double frame = 0;
  double contraction = 0, grown = 1;
  bool strict = false;  ///< refuse a mesh in place of repairing it
  CageParameters cages;
  double scale = 1;

  static void declare(Declaration<ObstacleParameters>& d);
};

/// The local meshes of an obstacle, which loads share while the parameters that choose them stay the same.
struct ObstacleMeshes {
  ValidatedMeshes frames;  ///< one mesh, or an animation with the same triangles
  ValidatedMeshes cages;   ///< outermost first
  std::string repair;      ///< how the mesh was repaired, naming the obstacle; empty if it was not

  /// Reads or makes them. Throws std::runtime_error naming the obstacle if its file cannot be read or its
  /// mesh is invalid.
  static ObstacleMeshes of(const ObstacleParameters& parameters, int number);
  /// Whether both parameters ask for the same meshes.
  static bool are_same(const ObstacleParameters& a, const ObstacleParameters& b);
};

/// The transform from an obstacle's local to world coordinates: scale, rotate, translate.
struct Pose {
  double scale = 1;
  Eigen::Vector3d rotate{0, 0, 0};     ///< about x, then y, then z [degree]
  Eigen::Vector3d translate{0, 0, 0};  ///< [m]

  /// Scale and rotation.
  Eigen::Matrix3d linear() const { return scale * rotation_matrix(rotate); }
  /// World coordinates (n×3) [m].
  Positions applied_to(const Positions& local) const {
    return (local * linear().transpose()).rowwise() + translate.transpose();
  }
  bool operator==(const Pose&) const = default;
};

/// The local mesh and the transform that determine an obstacle's vertex positions.
struct ObstacleGeometry {
  ValidatedMeshes frames;                ///< one mesh, or an animation with the same triangles
  double frame = 0;                      ///< index of the frame, interpolated linearly
  Eigen::Vector3d local_scale{1, 1, 1};  ///< factors on local coordinates
  Pose pose{};

  /// The scaled local positions (n×3) [m] at a frame, which the member `frame` does not influence.
  Positions local_positions(double frame) const;
  bool operator==(const ObstacleGeometry& other) const {
    return frame == other.frame && local_scale == other.local_scale && pose == other.pose &&
           are_equal(frames, other.frames);
  }
};

/// A mesh that the cloth collides with.
struct Obstacle {
  std::string name;
  std::optional<double> friction;  ///< μ, if it has its own
  ObstacleGeometry geometry;       ///< which the mesh follows from

  const Triangles& triangles() const { return geometry.frames[0]->mesh.triangles; }
  TriangleMesh mesh() const;  ///< in world coordinates
  bool operator==(const Obstacle& other) const {
    return geometry == other.geometry && name == other.name && friction == other.friction;
  }
  /// Chooses the meshes. On a level with a cage, the obstacle is the cage. Throws std::runtime_error naming
  /// the obstacle if its animation has no such frame.
  static Obstacle of(const ObstacleParameters& parameters, int number, const ObstacleMeshes& meshes,
                     int level = std::numeric_limits<int>::max());
};

/// All obstacles of a scene in one pose, also as one surface.
struct Obstacles : ObstacleSurface {
  std::vector<Obstacle> bodies;
  Positions local;  ///< local coordinates of the vertices [m]

  /// `topology` is that of these bodies in any pose.
  static Obstacles of(std::vector<Obstacle> bodies, std::shared_ptr<const ObstacleTopology> topology);
};

/// The topology of bodies as one surface.
ObstacleTopology topology_of(const std::vector<Obstacle>& bodies);

}  // namespace drape::ipc
