#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/plugin/parameters.h"
#include "plugins/contact/ipc/cages.h"
#include "plugins/contact/ipc/dihedrals.h"
#include "plugins/contact/ipc/sound_mesh.h"
#include "plugins/contact/ipc/surface.h"

namespace drape {

/// One obstacle as a config describes it: a mesh, turned and moved.
struct ObstacleParameters {
  std::string name, shape = "file", file;
  Eigen::Vector3d size{1, 1, 1};
  double radius = 0.5;
  int subdivisions = 4;
  std::vector<std::string> animation;
  double frame = 0;
  CageParameters cages;
  double scale = 1;
  Eigen::Vector3d rotate{0, 0, 0}, translate{0, 0, 0};
  std::optional<double> friction;

  static void declare(Declaration<ObstacleParameters>& d);
};

/// From an obstacle's own coordinates to the world's: scaled, turned, moved.
struct Pose {
  double scale = 1;
  Eigen::Vector3d rotate{0, 0, 0};  ///< about x, then y, then z [degree]
  Eigen::Vector3d translate{0, 0, 0};

  Eigen::Matrix3d linear() const;
  bool operator==(const Pose&) const = default;
};

/// What an obstacle's places follow from.
struct Form {
  std::vector<std::shared_ptr<const SoundMesh>> frames;  ///< one mesh, or a sequence with the same triangles
  double frame = 0;                                      ///< which of them, linear in between
  Eigen::Vector3d stretch{1, 1, 1};                      ///< factors on its own coordinates
  Pose pose;

  Positions own_places(double frame) const;
  bool operator==(const Form&) const = default;
};

/// A mesh in the way of the cloth.
struct Obstacle {
  std::string name;
  TriangleMesh mesh;               ///< where it is in the world
  std::optional<double> friction;  ///< μ, where it has its own
  Form form{};                     ///< without frames it never moves

  /// Whether it follows from the same; never where that is not known.
  bool operator==(const Obstacle& other) const {
    return !form.frames.empty() && form == other.form && name == other.name && friction == other.friction;
  }
  /// Throws std::runtime_error naming the obstacle if the file cannot be read or the mesh is not sound.
  /// On a level that has a cage, it is that.
  static Obstacle of(const ObstacleParameters& parameters, int number,
                     int level = std::numeric_limits<int>::max());
};

/// All obstacles of a scene as one surface.
struct Obstacles {
  std::vector<Obstacle> bodies;
  std::vector<int> first_vertex;  ///< of each body, and their number in all
  Positions vertices;             ///< of all bodies
  Surface surface;
  Dihedrals dihedrals;

  static Obstacles of(std::vector<Obstacle> bodies);
  int body_of(int vertex) const;
};

}  // namespace drape
