#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/kernel/interfaces/energy.h"
#include "core/kernel/interfaces/level.h"
#include "core/kernel/interfaces/material.h"

namespace drape {

/// Two primitives that intersect, named for messages.
struct Intersection {
  std::string first, second;                        ///< "cloth triangle 12", "ball: sphere"
  Eigen::Vector3d where = Eigen::Vector3d::Zero();  ///< a point near the intersection [m]
  std::array<int, 2> triangles = {-1, -1};          ///< of the cloth; -1: an obstacle
};

/// "cloth triangle 12 and ball: sphere at (0.1, 0, 0.3)".
std::string to_string(const Intersection& intersection);

/// Identifies a contact of one contact model from one state to the next.
using ContactKey = std::array<int, 5>;

/// The point of an obstacle that a contact touches: Σ weights_k vertex_k + offset.
struct ObstaclePoint {
  int obstacle = -1;                           ///< index in the contact model; -1: the contact has none
  std::array<int, 3> vertices = {-1, -1, -1};  ///< of the model's obstacles, padded with -1
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< [m]
};

/// A collision as friction needs it. Σ c_k x_k is the position of one side relative to the other.
struct FrictionContact {
  ContactKey key = {};
  std::array<int, 4> vertices;  ///< of the cloth; -1 for an obstacle's
  Eigen::Vector4d c = Eigen::Vector4d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit length
  double force = 0;                                  ///< μ times the normal force [N]
  ObstaclePoint touched = {};                        ///< none where the cloth touches itself
};

/// Friction contacts in groups whose energies are summed apart: one for each part of the collisions.
using FrictionContacts = std::vector<std::vector<FrictionContact>>;

/// The collisions closer than d̂ at one state, immutable (`Collisions` of ipc-toolkit). As an energy it is
/// their barrier potential B, and every x passed to it must be the state that it was built for. A stencil's
/// columns without a cloth vertex are -1. Collisions may refer to the BoundContact, which outlives them, but
/// not to the candidates that built them: other candidates replace those while the collisions are in use.
class Collisions : public BoundEnergy {
 public:
  virtual int contact_count() const = 0;
  virtual double smallest_gap() const = 0;  ///< [m]; +∞ without a contact
  /// The pressure over κ that the average newton of normal force acts with, by which κ is judged; 0 without
  /// contact or barrier.
  virtual double mean_pressure() const { return 0; }
  /// Appends the contacts with friction, in groups. By default none.
  virtual void append_friction_contacts([[maybe_unused]] FrictionContacts& groups) const {}
  /// ε_v h, below which friction is smoothed [m].
  virtual double friction_smoothing_distance() const { return 0; }
  /// Appends the smallest gap [m] of every element, in the order of stencils(), for programs that look at
  /// contacts. By default nothing.
  virtual void append_gaps([[maybe_unused]] std::vector<double>& gaps) const {}
};

/// Candidate pairs of the linear motion from x0 to x1, by the broad phase. May refer to the BoundContact.
class CollisionCandidates {
 public:
  virtual ~CollisionCandidates() = default;
  /// The largest collision-free step, by continuous collision detection. Every gap keeps a fraction.
  virtual StepLimit max_step() const = 0;
  /// The collisions at x, a state of this motion no farther than max_step.
  virtual std::unique_ptr<Collisions> build_collisions(const Positions& x) const = 0;
};

/// The smallest gap of a state.
struct SmallestGap {
  std::string between;  ///< "cloth triangle 12 and ball: sphere"; empty without a gap below d̂
  double gap = std::numeric_limits<double>::infinity();  ///< [m]
};

/// How far the cloth is from an obstacle.
struct ObstacleGap {
  std::string obstacle;       ///< its name in messages
  double gap = 0;             ///< the shortest distance [m]
  Eigen::Vector3d direction;  ///< unit, from the obstacle towards the cloth there
  bool is_bounded = true;     ///< false for a half-space, of which obstacles() has a square
};

/// A contact model bound to one level and its obstacles. Immutable.
class BoundContact {
 public:
  virtual ~BoundContact() = default;
  /// Runs the broad phase for the motion from x0 to x1 (n×3, copied). x0 must be free of intersections.
  virtual std::unique_ptr<CollisionCandidates> build_candidates(const Positions& x0,
                                                                const Positions& x1) const = 0;
  /// Pairs of primitives that intersect or touch at x. Meshes are tested with exact predicates.
  virtual std::vector<Intersection> intersections(const Positions& x) const = 0;
  /// The obstacles as meshes, in the order of the model's parameters: for drawing, and for pins to follow.
  /// None by default.
  virtual std::vector<TriangleMesh> obstacles() const { return {}; }

  /// d̂, below which the barrier acts [m]; 0 for a model without a barrier.
  virtual double dhat() const { return 0; }
  /// The barrier stiffness κ [Pa]; 0 for a model without a barrier.
  virtual double stiffness() const { return 0; }
  /// This model with another κ [Pa]; null if its κ is a parameter of the experiment, or if it has none.
  virtual std::shared_ptr<const BoundContact> with_stiffness([[maybe_unused]] double stiffness) const {
    return nullptr;
  }
  /// One line on pairs of primitives that the barrier leaves out, for messages; empty if there are none.
  virtual std::string remark() const { return ""; }

  /// The smallest gap at x, for a model with a barrier.
  virtual SmallestGap smallest_gap([[maybe_unused]] const Positions& x) const { return {}; }
  /// The gap of each obstacle at x (n×3), however far it is, in the order of obstacles(). Any number where x
  /// intersects the obstacle, and not positive where x is wholly in it. None by default.
  virtual std::vector<ObstacleGap> obstacle_gaps([[maybe_unused]] const Positions& x) const { return {}; }

  /// The largest collision-free step of the obstacles (kinematic obstacles of IPC) from their placement in
  /// `before` to their placement here, with the cloth fixed at x. `before` must be of the same contact model
  /// and level. Obstacle parameters are interpolated linearly, so obstacles rotate along arcs. Returns 1 for
  /// obstacles that have not changed, and for obstacles whose parameters a caller has interpolated by a
  /// fraction that an earlier call returned. Throws std::runtime_error naming an obstacle whose topology
  /// changed. By default a half if the cloth intersects something here.
  virtual StepLimit max_step(const BoundContact& before, const Positions& x) const;
  /// The displacement of an obstacle's material point from `before`, whose contacts touch it there, to here
  /// [m]. By default obstacles do not move.
  virtual Eigen::Vector3d displacement([[maybe_unused]] const BoundContact& before,
                                       [[maybe_unused]] const ObstaclePoint& point) const {
    return {0, 0, 0};
  }
};

/// The contacts of one level. Models of the level under different loads may share them.
using BoundContacts = std::vector<std::shared_ptr<const BoundContact>>;

/// The barrier stiffness κ of each contact model [Pa].
using ContactStiffness = std::vector<double>;

/// A kind of contact, made by name from its parameters.
class ContactModel {
 public:
  static constexpr const char* kind = "contact";  ///< in the registry
  virtual ~ContactModel() = default;
  /// Null when there is nothing to collide with: no contact code runs then.
  virtual std::unique_ptr<BoundContact> bind(const Level& level, const Material& material) const = 0;
  /// Binds under another load. A model whose binding is costly shares what did not change with `before`,
  /// which a model of the same plugin was bound to on this level.
  virtual std::unique_ptr<BoundContact> rebind(const Level& level, const Material& material,
                                               [[maybe_unused]] const BoundContact& before) const {
    return bind(level, material);
  }
  /// How the model changed its input, a line each, such as "obstacle scan: dropped 3 loose vertices".
  virtual std::vector<std::string> input_remarks() const { return {}; }
};

}  // namespace drape
