#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/app/experiment/dress.h"
#include "core/kernel/interfaces/material.h"
#include "core/kernel/plugin/config_node.h"
#include "core/kernel/plugin/declaration.h"
#include "core/numerics/mesh/grain.h"
#include "core/numerics/mesh_files/file_coordinates.h"
#include "core/numerics/step/newton_parameters.h"

namespace drape {

class Schema;

/// One closed outline of a polygonal cloth.
struct LoopParameters {
  std::vector<double> points;  ///< x0, y0, x1, y1, … [m]
  static void declare(Declaration<LoopParameters>& d);
};

/// The cloth's material, from which a fabric of a table may stand (core/app/experiment/fabrics.h).
struct MaterialParameters : Material {
  ConfigNode fabric;                       ///< NAME, or {file, row}
  std::optional<std::string> from_fabric;  ///< the fabric that gave the numbers of a saved config
  static void declare(Declaration<MaterialParameters>& d);
};

/// A box of the rest shape whose triangles, by their centroids, have a grain of their own.
struct GrainRegionParameters {
  Eigen::Vector3d lower{0, 0, 0}, upper{0, 0, 0};
  double grain = 0;
  static void declare(Declaration<GrainRegionParameters>& d);
};

/// The folds along the seams of a cloth of flat pieces.
struct SeamParameters {
  double angle = 0;
  double stiffness = 1;
  static void declare(Declaration<SeamParameters>& d);
};

/// How the cloth's file was read, of a saved config whose cloth is drape's own copy.
struct AsReadParameters : FileCoordinates {
  std::string file;
  double scale = 1;
  Eigen::Vector3d rotate{0, 0, 0};
  double join = 0;
  static void declare(Declaration<AsReadParameters>& d);

  /// From positions of a cloth of that file to the file's own coordinates.
  Positions in_file(Positions x) const;
};

/// The coarsest level: a flat pattern, or a mesh file that is read by its FileCoordinates, scaled, then
/// rotated.
struct ClothParameters : FileCoordinates {
  std::string shape = "square";
  double side = 1;
  Eigen::Vector2d size{1, 1};
  double radius = 0.5;
  std::vector<LoopParameters> loops;
  std::string file;
  double scale = 1;
  Eigen::Vector3d rotate{0, 0, 0};
  std::string rest = "space";
  std::optional<std::string> uv_unit;
  double join = 0;
  SeamParameters seams;
  std::optional<double> ease;
  AsReadParameters as_read;
  std::string triangulation = "one_way";
  std::optional<int> vertices;
  std::optional<double> edge_length;
  int columns = 0, rows = 0;
  int seed = 1;
  std::optional<double> grain;
  GrainAxis grain_along = GrainAxis::x;
  std::vector<GrainRegionParameters> grain_regions;
  bool is_meshed_anew() const { return shape == "file" && (vertices || edge_length); }
  bool is_sewn() const { return rest == "uv" || shape == "pattern"; }
  int vertex_count() const { return vertices.value_or(1024); }  ///< about that of a generated cloth
  static void declare(Declaration<ClothParameters>& d);
};

/// The start: the rest shape, or that of a file, scaled, then rotated, then translated.
struct StartParameters {
  std::string file;
  std::optional<std::string> unit, up;  ///< of the file; without a value, those of the cloth's file
  Eigen::Vector3d scale{1, 1, 1};
  Eigen::Vector3d rotate{0, 0, 0};
  Eigen::Vector3d translate{0, 0, 0};
  double perturbation = 0;
  double perturbation_wavelength = 0.25;
  int seed = 1;
  /// The initial position of a vertex; `noise` is normal to the pattern [m].
  Eigen::Vector3d transformed(const Eigen::Vector3d& rest, double noise = 0) const;
  /// How the start's file is read beside this cloth.
  FileCoordinates file_coordinates(const ClothParameters& cloth) const {
    // A polygon's unit is that of its points; a mesh of it is drape's own, in metres.
    const FileCoordinates other = cloth.shape == "file" ? FileCoordinates(cloth) : FileCoordinates();
    return {unit.value_or(other.unit), up.value_or(other.up)};
  }
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
  std::optional<std::string> piece, label;
  std::vector<int> label_edges;  ///< of the label on the coarsest level, two ends each
  std::optional<Eigen::Vector3d> translate;
  std::optional<Eigen::Vector3d> rotate;
  Eigen::Vector3d centre{0, 0, 0};

  bool has_transform() const { return translate || rotate; }
  /// The target of a vertex with this rest position: rotated about `centre`, then translated.
  Eigen::Vector3d target(const Eigen::Vector3d& rest) const;
};

/// The obstacle that a pin follows; none without its name.
struct FollowParameters {
  std::string obstacle;
  std::vector<int> vertices;
  static void declare(Declaration<FollowParameters>& d);
};

/// Dirichlet boundary condition (hard positions): the vertices stay at their targets on every level.
struct PinParameters : VertexSelection {
  FollowParameters follow;
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
struct ScheduleKey {
  std::string parameter;
  std::vector<double> times;
  ConfigNode written;  ///< `values`
  KeyInterpolation interpolation = KeyInterpolation::linear;
  static void declare(Declaration<ScheduleKey>& d);

  // Set by read_keys, for a valid experiment:
  std::vector<std::vector<double>> values;  ///< at each of the times, equally many numbers
  std::string section;                      ///< of the experiment: the path's first word
  std::size_t item = 0;                     ///< of that section, if it is a list
  std::vector<double> at(double time) const;
  bool is_of_contact() const;
};

/// Load stepping: parameters that change in increments while a level is solved.
struct ScheduleParameters {
  double duration = 0;
  int steps = 1;
  bool equilibrate = false;
  std::vector<ScheduleKey> keys;
  static void declare(Declaration<ScheduleParameters>& d);

  /// The pseudo-time at the end of an increment, in the keys' unit.
  double time(int increment) const;
  /// The values of all keys, one after another.
  std::vector<double> values_at(double time) const;
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

/// Levels below the cloth's own mesh.
struct HierarchyParameters {
  int coarsen = 0, coarsest = 0;
  bool multigrid = false;
  static void declare(Declaration<HierarchyParameters>& d);
};

/// The refiner of an experiment that names none.
inline constexpr const char* default_refiner = "loop";

/// A whole experiment file.
struct ExperimentParameters {
  std::string name;
  std::string description;
  ClothParameters cloth;
  int levels = 4;
  HierarchyParameters hierarchy;
  MaterialParameters material;
  StartParameters start;
  std::vector<PinParameters> pins;
  std::vector<HandleParameters> handles;
  DressParameters dress;
  ScheduleParameters schedule;
  std::vector<ConfigNode> energies;
  ConfigNode refiner, contact;
  std::vector<ConfigNode> obstacles;  ///< as written; a contact model reads each
  double friction = 0;                ///< μ
  NewtonParameters newton;
  ConfigNode methods;
  std::vector<ConfigNode> metrics;
  ReferenceParameters reference;
  int snapshots = 8;
  IntersectionCheck check_intersections = IntersectionCheck::every_level;

  /// Levels of the cloth, those below its own mesh included.
  int level_count() const { return hierarchy.coarsen + levels; }
  static void declare(Declaration<ExperimentParameters>& d);
};

const Schema& experiment_schema();

/// An experiment's parameters as a map with all of them, and read from one; appends faults.
ConfigNode node_of(const ExperimentParameters& parameters);
ExperimentParameters parameters_of(const ConfigNode& node, ConfigErrors& errors);

}  // namespace drape
