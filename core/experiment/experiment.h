#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/model/contact_model.h"
#include "core/model/level_model.h"
#include "core/model/material.h"
#include "core/model/metric.h"
#include "core/model/refiner.h"
#include "core/model/solver.h"
#include "core/numerics/newton_parameters.h"
#include "core/plugin/registry.h"

namespace drape {

/// One closed outline of a polygonal cloth.
struct LoopParameters {
  std::vector<double> points;  ///< x0, y0, x1, y1, … [m]
  static void declare(Declaration<LoopParameters>& d);
};

/// The flat pattern, or the mesh file, that the coarsest level is.
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

/// Where the cloth starts: rest, or the file's shape → scaled → rotated → moved.
struct StartParameters {
  std::string file;
  Eigen::Vector3d scale{1, 1, 1};
  Eigen::Vector3d rotate{0, 0, 0};
  Eigen::Vector3d translate{0, 0, 0};
  double perturbation = 0;
  double perturbation_wavelength = 0.25;
  int seed = 1;
  /// Where a vertex with this rest place starts; `noise` is across the pattern [m].
  Eigen::Vector3d place(const Eigen::Vector3d& rest, double noise = 0) const;
  static void declare(Declaration<StartParameters>& d);
};

/// Which vertices, by a region of the rest shape that means the same on every level, and where they belong.
struct PlaceParameters {
  std::string region = "nearest";
  Eigen::Vector3d point{0, 0, 0};
  double radius = 0;
  Eigen::Vector3d lower{0, 0, 0}, upper{0, 0, 0};
  std::vector<int> vertices;
  std::optional<Eigen::Vector3d> move;
  std::optional<Eigen::Vector3d> turn;
  Eigen::Vector3d about{0, 0, 0};

  bool moved() const { return move || turn; }
  /// Of a vertex with this rest place: turned, then moved.
  Eigen::Vector3d place(const Eigen::Vector3d& rest) const;
};

/// Hard positions: vertices held in place on every level.
struct PinParameters : PlaceParameters {
  static void declare(Declaration<PinParameters>& d);
};

/// Soft positions: vertices pulled to places, as by a hand.
struct HandleParameters : PlaceParameters {
  std::optional<double> stiffness;
  static void declare(Declaration<HandleParameters>& d);
};

/// How a keyed value goes from one key to the next.
enum class Between { linear, log, jump };

/// One parameter of the experiment over pseudo-time.
struct KeyParameters {
  std::string set;
  std::vector<double> at;
  ConfigNode to;
  Between between = Between::linear;
  static void declare(Declaration<KeyParameters>& d);
};

/// Load stepping: parameters that change while a level is solved.
struct ScheduleParameters {
  double duration = 0;
  int steps = 1;
  bool settle = false;
  std::vector<KeyParameters> keys;
  static void declare(Declaration<ScheduleParameters>& d);
};

/// The state that the methods' errors are measured against, beside each method's own finest one.
struct ReferenceParameters {
  /// In place of a method's name: of the finest states that have converged, that of lowest energy.
  static constexpr const char* lowest = "lowest";
  std::string method;
  double force_tolerance = 0;
  std::string file;
  static void declare(Declaration<ReferenceParameters>& d);
};

/// When exact predicates count the intersections.
enum class Verify { every_level, every_step };

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
  int frames = 8;
  Verify verify = Verify::every_level;
  static void declare(Declaration<ExperimentParameters>& d);
};

/// An experiment that has been read and checked, with its plugins made but nothing built yet.
struct Experiment {
  ExperimentParameters parameters;
  ConfigNode source;    ///< as written, with places
  ConfigNode resolved;  ///< with every parameter of every plugin in it
  std::vector<NamedEnergy> energies;
  std::shared_ptr<Refiner> refiner;
  std::vector<std::shared_ptr<ContactModel>> contacts;
  std::vector<std::pair<std::string, std::shared_ptr<Solver>>> methods;
  std::vector<std::pair<std::string, std::shared_ptr<Metric>>> metrics;
  const Registry* registry = nullptr;  ///< that the plugins are from; for those of a schedule's conditions

  /// The solver of one of the methods. Throws std::logic_error where there is no such method.
  const Solver& solver_of(const std::string& method) const;
  /// Where a key of the file is set; without it, where the file begins.
  Location place_of(const std::string& key) const;
};

/// An error unless the name, of an experiment, a method or a sweep, can be one of files and a cell of a
/// table.
void check_name(const std::string& what, const std::string& name, const Location& where,
                ConfigErrors& errors);

/// Values given beside the file, `key.path=value`, in order.
using Overrides = std::vector<std::pair<std::string, std::string>>;

/// Reads an experiment, collecting everything that is wrong with it; empty if anything is.
std::optional<Experiment> read_experiment(const std::filesystem::path& file, const Overrides& overrides,
                                          const Registry& registry, ConfigErrors& errors);

/// The same from a file's map that has been read already, overrides and all.
std::optional<Experiment> read_experiment(ConfigNode source, const Registry& registry, ConfigErrors& errors);

/// The levels, models and starts of an experiment. Not movable: models refer to the hierarchy.
struct Scene {
  Hierarchy hierarchy;
  std::vector<NamedEnergy> energies;  ///< that the models were bound from, handles among them
  std::vector<std::unique_ptr<LevelModel>> models;
  std::vector<Positions> starts;
  std::optional<Positions> reference;      ///< on the finest level, where the experiment names a file with it
  std::unique_ptr<LoadStepping> schedule;  ///< null where the experiment has none

  Problem problem() const;
};

/// What becomes of a start that touches something.
enum class TouchingStart { refused, kept };

/// Builds the scene; null, with every fault of the mesh, every pin that holds nothing and what the start
/// touches appended, if it cannot be built. A touching start is `kept` for repair_start alone.
std::unique_ptr<Scene> build_scene(const Experiment& experiment, ConfigErrors& errors,
                                   TouchingStart touching = TouchingStart::refused);

/// Contact keeps apart what is apart: a start that touches something is refused, and says where.
void refuse_touching_start(const Experiment& experiment, const LevelModel& model, const Positions& start,
                           ConfigErrors& errors);

}  // namespace drape
