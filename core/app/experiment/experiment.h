#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/kernel/model/contact_model.h"
#include "core/kernel/model/level_model.h"
#include "core/kernel/model/material.h"
#include "core/kernel/model/metric.h"
#include "core/kernel/model/refiner.h"
#include "core/kernel/model/solver.h"
#include "core/kernel/plugin/registry.h"
#include "core/kernel/solve/newton_parameters.h"

namespace drape {

/// One closed outline of a polygonal cloth.
struct LoopParameters {
  std::vector<double> points;  ///< x0, y0, x1, y1, … [m]
  static void declare(Declaration<LoopParameters>& d);
};

/// The coarsest level: a flat pattern or a mesh file.
struct ClothParameters {
  std::string shape = "square";
  double side = 1;
  Eigen::Vector2d size{1, 1};
  double radius = 0.5;
  std::vector<LoopParameters> loops;
  std::string file;
  std::string triangulation = "one_way";
  int vertices = 1024;
  int columns = 0, rows = 0;
  int seed = 1;
  static void declare(Declaration<ClothParameters>& d);
};

/// The initial state: the rest shape, or that of a file, scaled, then rotated, then translated.
struct StartParameters {
  std::string file;
  Eigen::Vector3d scale{1, 1, 1};
  Eigen::Vector3d rotate{0, 0, 0};
  Eigen::Vector3d translate{0, 0, 0};
  double perturbation = 0;
  double perturbation_wavelength = 0.25;
  int seed = 1;
  /// The initial position of a vertex; `noise` is normal to the pattern [m].
  Eigen::Vector3d transformed(const Eigen::Vector3d& rest, double noise = 0) const;
  static void declare(Declaration<StartParameters>& d);
};

/// A boundary condition's vertices, by a region of the rest shape that means the same on every level, and the
/// rigid motion that gives their targets.
struct VertexSelection {
  std::string region = "nearest";
  Eigen::Vector3d point{0, 0, 0};
  double radius = 0;
  Eigen::Vector3d lower{0, 0, 0}, upper{0, 0, 0};
  std::vector<int> vertices;
  std::optional<Eigen::Vector3d> translate;
  std::optional<Eigen::Vector3d> rotate;
  Eigen::Vector3d centre{0, 0, 0};

  bool has_transform() const { return translate || rotate; }
  /// The target of a vertex with this rest position: rotated about `centre`, then translated.
  Eigen::Vector3d target(const Eigen::Vector3d& rest) const;
};

/// Dirichlet boundary condition (hard positions): the vertices stay at their targets on every level.
struct PinParameters : VertexSelection {
  static void declare(Declaration<PinParameters>& d);
};

/// Penalty boundary condition (soft positions): springs pull the vertices to their targets.
struct HandleParameters : VertexSelection {
  std::optional<double> stiffness;
  static void declare(Declaration<HandleParameters>& d);
};

/// How a keyed value goes from one time to the next.
enum class KeyInterpolation { linear, log, step };

/// One parameter of the experiment over pseudo-time.
struct KeyParameters {
  std::string parameter;
  std::vector<double> times;
  ConfigNode values;
  KeyInterpolation interpolation = KeyInterpolation::linear;
  static void declare(Declaration<KeyParameters>& d);
};

/// Load stepping: parameters that change in increments while a level is solved.
struct ScheduleParameters {
  double duration = 0;
  int steps = 1;
  bool equilibrate = false;
  std::vector<KeyParameters> keys;
  static void declare(Declaration<ScheduleParameters>& d);
};

/// The state that errors are measured against, beside each method's own finest one.
struct ReferenceParameters {
  /// In place of a method's name: the converged finest state of lowest energy.
  static constexpr const char* lowest = "lowest";
  std::string method;
  double force_tolerance = 0;
  std::string file;
  static void declare(Declaration<ReferenceParameters>& d);
};

/// How often exact predicates count the intersections.
enum class IntersectionCheck { every_level, every_step };

/// A whole experiment file.
struct ExperimentParameters {
  std::string name;
  std::string description;
  std::string table1_scene;
  ClothParameters cloth;
  int levels = 4;
  Material material;
  StartParameters start;
  std::vector<PinParameters> pins;
  std::vector<HandleParameters> handles;
  ScheduleParameters schedule;
  std::vector<ConfigNode> energies;
  ConfigNode refiner, contact;
  NewtonParameters newton;
  ConfigNode methods;
  std::vector<ConfigNode> metrics;
  ReferenceParameters reference;
  int snapshots = 8;
  IntersectionCheck check_intersections = IntersectionCheck::every_level;
  static void declare(Declaration<ExperimentParameters>& d);
};

/// A validated experiment with its plugins, before any level is built.
struct Experiment {
  ExperimentParameters parameters;
  ConfigNode source;    ///< as written, with locations
  ConfigNode resolved;  ///< with every parameter of every plugin in it
  std::vector<NamedEnergy> energies;
  std::shared_ptr<Refiner> refiner;
  std::vector<std::shared_ptr<ContactModel>> contacts;
  std::vector<std::pair<std::string, std::shared_ptr<Solver>>> methods;
  std::vector<std::pair<std::string, std::shared_ptr<Metric>>> metrics;
  const Registry* registry = nullptr;  ///< of the plugins; a schedule makes others of them

  /// The solver of a method. Throws std::logic_error for an unknown method.
  const Solver& solver_of(const std::string& method) const;
  /// The location of a key's value in the file; without the key, the file's beginning.
  Location location_of(const std::string& key) const;
};

/// Appends an error unless the name (of an experiment, a method or a sweep) can be part of file names.
void check_name(const std::string& what, const std::string& name, const Location& where,
                ConfigErrors& errors);

/// Values from the command line, `key.path=value`, in order.
using Overrides = std::vector<std::pair<std::string, std::string>>;

/// Reads and validates an experiment; empty, with every error appended, if it is not valid.
std::optional<Experiment> read_experiment(const std::filesystem::path& file, const Overrides& overrides,
                                          const Registry& registry, ConfigErrors& errors);

/// The same from a map that has been read already, overrides included.
std::optional<Experiment> read_experiment(ConfigNode source, const Registry& registry, ConfigErrors& errors);

/// The levels, models and initial states of an experiment. Not movable: models refer to the hierarchy.
struct Scene {
  Hierarchy hierarchy;
  std::vector<NamedEnergy> energies;                      ///< of the models, handles included
  std::vector<std::shared_ptr<const LevelModel>> models;  ///< at the start, before any load stepping
  std::vector<Positions> starts;
  std::optional<Positions> reference;      ///< on the finest level, if the experiment names its file
  std::unique_ptr<LoadStepping> schedule;  ///< null without one

  /// The model of a level under the load that it has reached; valid until the next load step.
  const LevelModel& model(int level) const;
  const LevelModel& finest_model() const { return model(static_cast<int>(models.size()) - 1); }
  Problem problem() const;
};

/// Whether an initial state that intersects something is refused.
enum class IntersectingStart { refused, allowed };

/// Builds the scene; null, with every fault of the mesh, of pins and of the initial state appended, if that
/// is not possible. An intersecting start is `allowed` for repair_start and warm starts alone.
std::unique_ptr<Scene> build_scene(const Experiment& experiment, ConfigErrors& errors,
                                   IntersectingStart intersecting = IntersectingStart::refused);

/// Appends an error for every intersection of an initial state: contact only preserves intersection-free
/// states.
void refuse_intersecting_start(const Experiment& experiment, const LevelModel& model, const Positions& start,
                               ConfigErrors& errors);

}  // namespace drape
