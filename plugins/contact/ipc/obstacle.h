#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/mesh/topology.h"
#include "core/plugin/parameters.h"
#include "plugins/contact/ipc/surface.h"

namespace drape {

/// One obstacle as a config describes it: a mesh, turned and moved.
struct ObstacleParameters {
  std::string name, shape = "file", file;
  Eigen::Vector3d size{1, 1, 1};
  double radius = 0.5;
  int subdivisions = 4;
  double scale = 1;
  Eigen::Vector3d rotate{0, 0, 0}, translate{0, 0, 0};
  std::optional<double> friction;

  static void declare(Declaration<ObstacleParameters>& d);
};

/// A mesh in the way of the cloth, which never moves.
struct Obstacle {
  std::string name;
  TriangleMesh mesh;
  std::optional<double> friction;  ///< μ, where it has its own

  /// Throws std::runtime_error naming the obstacle if the file cannot be read or the mesh is not sound.
  static Obstacle of(const ObstacleParameters& parameters, int number);
};

/// All obstacles of a scene as one surface.
struct Obstacles {
  std::vector<Obstacle> bodies;
  std::vector<int> first_vertex;  ///< of each body, and their number in all
  Positions vertices;             ///< of all bodies
  Surface surface;

  static Obstacles of(std::vector<Obstacle> bodies);
  int body_of(int vertex) const;
};

}  // namespace drape
