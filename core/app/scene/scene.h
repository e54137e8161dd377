#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/app/experiment/cloth.h"
#include "core/app/experiment/experiment.h"
#include "core/kernel/interfaces/contact_model.h"
#include "core/numerics/hierarchy/hierarchy.h"

namespace drape {

/// A vertex of a pin that follows an obstacle, and the point of the obstacle that it is attached to.
struct FollowingVertex {
  int pin = 0, vertex = 0;
  Eigen::Index obstacle = 0;                          ///< in LevelModel::obstacles
  std::string name;                                   ///< the obstacle's, as the pin has it
  Eigen::Vector3i corners{0, 0, 0};                   ///< of the followed triangle
  Eigen::Matrix3d first = Eigen::Matrix3d::Zero();    ///< these under the first load, one a column [m]
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();  ///< barycentric coordinates of the point
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();   ///< the target from there, in the triangle's frame [m]
};
using FollowingVertices = std::vector<FollowingVertex>;

/// A border of a garment that is sewn.
struct GarmentOpening {
  std::vector<std::string> pieces;                   ///< along it, each once
  double length = 0;                                 ///< [m]
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< mean of its vertices [m]
  bool passed = false;                               ///< whether a part of the body passes through it
};

/// A cloth that is put on a body before it is loaded. Its pieces are measured one by one, and energies are
/// not compared with the start, where its seams are long.
struct Garment {
  std::string remark;      ///< on its start
  ConfigErrors warnings;   ///< on its start
  ConfigError no_restart;  ///< why it begins from no other state
  /// The openings at x (n×3) [m], the longest first.
  std::function<std::vector<GarmentOpening>(const LevelModel& model, const Positions& x)> openings;
  /// A result of the finest level with what the garment is found to be, where it has come to rest.
  std::function<LevelResult(LevelResult result)> judged;
};

/// The problem of an experiment, and what it was made from.
struct Scene : Problem {
  explicit Scene(Hierarchy all) : Problem{levels, {}, {}, nullptr}, levels(std::move(all)) {}
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  const Hierarchy levels;                    ///< the problem's
  std::vector<NamedEnergy> energies;         ///< of the models, handles included
  std::vector<Positions> placed;             ///< the starts without noise, where pins and handles hold [m]
  std::vector<FollowingVertices> following;  ///< of each level
  std::optional<Garment> garment;            ///< if the cloth is one
  std::optional<Positions> reference;        ///< on the finest level, if the experiment names its file

  /// The finest level's model under the load that it has reached; valid until the next load step.
  const LevelModel& finest_model() const { return *model(finest()); }
};

/// How the contact models treat their input and the scene, a line each: repaired obstacles, pairs of the
/// cloth that have no barrier.
std::vector<std::string> remarks_of(const Experiment& experiment, const Scene& scene);

/// How many border vertices of a cloth from a file lie on others, as seams that stand twice do, and a remedy;
/// empty without any.
std::string unwelded_fault(const Experiment& experiment, const Level& level);

/// Whether one of these pairs is of the cloth alone.
bool touches_itself(const std::vector<Intersection>& pairs);

/// Appends an error for every intersection of a start: contact only preserves intersection-free
/// states.
void refuse_intersecting_start(const Experiment& experiment, const LevelModel& model, const Positions& start,
                               ConfigErrors& errors);

/// The generalised winding number of the mesh around p [m]: 1 inside a closed mesh that faces outwards, -1 in
/// one that faces inwards, 0 outside (solid angles: van Oosterom and Strackee 1983).
double winding_number(const TriangleMesh& mesh, const Eigen::Vector3d& p);
/// Which of the points (n×3) [m] lie inside a closed mesh that faces outwards, or, if that is asked, inwards.
std::vector<char> are_inside(const Positions& points, const TriangleMesh& mesh, bool facing_inwards = false);
/// Whether one does. Of a cloth that intersects nothing, a vertex of each connected part will do.
bool is_inside(const Positions& points, const TriangleMesh& mesh, bool facing_inwards = false);

/// Translates a start that intersects something, or is closer than a micrometre to it, by the shortest way
/// up, to a side or down that leads across no obstacle (CrossedParts), equally on every level, until nothing
/// intersects, no obstacle encloses the cloth and as few obstacles as possible are within d̂. Returns the
/// translation [m], zero if none was necessary. It is added to the experiment's `start.translate`, and the
/// caller must build the scene again. Appends an error if no translation is found, or if an intersecting
/// cloth has pins.
Eigen::Vector3d repair_start(Experiment& experiment, const Scene& scene, ConfigErrors& errors);

}  // namespace drape
