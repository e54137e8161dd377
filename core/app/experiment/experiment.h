#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/app/experiment/contact_configs.h"
#include "core/kernel/interfaces/contact_model.h"
#include "core/kernel/interfaces/metric.h"
#include "core/kernel/interfaces/refiner.h"
#include "core/kernel/interfaces/solver.h"
#include "core/kernel/plugin/registry.h"
#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/model/level_model.h"

namespace drape {

struct Scene;

/// A validated experiment with its plugins, before any level is built.
struct Experiment {
  ExperimentParameters parameters;
  ConfigNode source;    ///< as written, with locations
  ConfigNode resolved;  ///< with every parameter of every plugin in it
  std::vector<NamedEnergy> energies;
  std::vector<PluginParameters> energy_parameters;  ///< of each
  std::shared_ptr<Refiner> refiner;
  std::vector<std::shared_ptr<ContactModel>> contacts;
  std::vector<ContactConfig> contact_configs;  ///< of each
  std::vector<std::pair<std::string, std::shared_ptr<Solver>>> methods;
  std::vector<std::pair<std::string, std::shared_ptr<Metric>>> metrics;
  const Registry* registry = nullptr;  ///< of the plugins

  /// The solver of a method. Throws std::logic_error for an unknown method.
  const Solver& solver_of(const std::string& method) const;
  /// The type of that solver, which is not always the method's name.
  std::string solver_type(const std::string& method) const;
  /// The location of a key's value in the file; without the key, the file's beginning.
  Location location_of(const std::string& key) const;
  /// Indices in `obstacles` of the contact models' obstacles, model by model, as obstacles_of has them; and
  /// their names, empty for an obstacle without one.
  std::vector<std::size_t> obstacle_order() const;
  std::vector<std::string> obstacle_names() const;
  /// How the contact models treat their input and a scene of the experiment, a line each: repaired obstacles,
  /// pairs of the cloth that have no barrier.
  std::vector<std::string> remarks(const Scene& scene) const;
};

/// Appends an error unless the name (of an experiment, a method or a sweep) can be part of file names.
void check_name(const std::string& what, const std::string& name, const Location& where,
                ConfigErrors& errors);

/// A value from the command line.
struct Override {
  std::string key, value;               ///< `key.path=value`
  std::string option = "--set " + key;  ///< for messages
};
using Overrides = std::vector<Override>;  ///< in order

/// Reads and validates an experiment; empty, with every error appended, if it is not valid.
std::optional<Experiment> read_experiment(const std::filesystem::path& file, const Overrides& overrides,
                                          const Registry& registry, ConfigErrors& errors);

/// The same from a map that has been read already, overrides included.
std::optional<Experiment> read_experiment(ConfigNode source, const Registry& registry, ConfigErrors& errors);

/// Appends the faults of the cloth's and the start's mesh files, which are read. For experiments that are not
/// valid, whose scene cannot be built: otherwise build_scene appends them.
void check_mesh_files(const Experiment& experiment, ConfigErrors& errors);

/// A vertex of a pin that follows an obstacle, and the point of the obstacle that it is attached to.
struct FollowingVertex {
  int pin = 0, vertex = 0;
  Eigen::Index obstacle = 0;                          ///< in obstacles_of
  std::string name;                                   ///< the obstacle's, as the pin has it
  Eigen::Vector3i corners{0, 0, 0};                   ///< of the followed triangle
  Eigen::Matrix3d first = Eigen::Matrix3d::Zero();    ///< these under the first load, one a column [m]
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();  ///< barycentric coordinates of the point
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();   ///< the target from there, in the triangle's frame [m]
};
using FollowingVertices = std::vector<FollowingVertex>;

/// The problem of an experiment, and what it was made from.
struct Scene : Problem {
  explicit Scene(Hierarchy all) : Problem{levels, {}, {}, nullptr}, levels(std::move(all)) {}
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  const Hierarchy levels;                    ///< the problem's
  std::vector<NamedEnergy> energies;         ///< of the models, handles included
  std::vector<Positions> placed;             ///< the starts without noise, where pins and handles hold [m]
  std::vector<FollowingVertices> following;  ///< of each level
  std::optional<Positions> reference;        ///< on the finest level, if the experiment names its file

  /// The finest level's model under the load that it has reached; valid until the next load step.
  const LevelModel& finest_model() const { return *model(finest()); }
};

/// Whether a start that intersects something is refused.
enum class IntersectingStart { refused, allowed };

/// Builds the scene; null, with every fault of the mesh, of pins and of the start appended, if that
/// is not possible. An intersecting start is `allowed` for repair_start and warm starts alone.
std::unique_ptr<Scene> build_scene(const Experiment& experiment, ConfigErrors& errors,
                                   IntersectingStart intersecting = IntersectingStart::refused);

/// Appends an error for every intersection of a start: contact only preserves intersection-free
/// states.
void refuse_intersecting_start(const Experiment& experiment, const LevelModel& model, const Positions& start,
                               ConfigErrors& errors);

}  // namespace drape
