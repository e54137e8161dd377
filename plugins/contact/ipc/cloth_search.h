#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "core/numerics/collision_detection/broad_phase.h"
#include "core/numerics/contact/candidates.h"
#include "plugins/contact/ipc/obstacle.h"

namespace drape::ipc {

/// A pose of the obstacles, prepared for searches with one d̂ and one kind of broad phase.
struct ObstacleTree {
  std::shared_ptr<const Obstacles> obstacles;
  Eigen::RowVector3d origin;  // of the boxes, and of those that are compared with them
  SweptBoxes boxes;
  Dihedrals dihedrals;
  std::shared_ptr<const BroadPhase> tree;

  ObstacleTree(std::shared_ptr<const Obstacles> all, double dhat, PoseTrees& trees);
};

/// Trees and lists of the searches for the cloth's pairs, reused for speed. Results do not depend on earlier
/// searches.
struct ClothSearch {
  std::mutex busy;                       // guards the other members
  std::unique_ptr<SelfPairSearch> self;  // null without self-contact
  SweptBoxes boxes;
  std::unique_ptr<BroadPhase> tree;
  AdjacencyList rows;
  std::vector<ObstaclePair> pairs;
  /// The pairs within d̂ and a margin at one time. Until cloth and obstacles have moved by the margin, every
  /// pair that may come within d̂ is among them.
  struct Skin {
    Positions cloth;
    std::shared_ptr<const Obstacles> obstacles;  // null before the first
    double margin = 0;                           // [m]
    long row_count = 0;                          // of its search, at least as many as searches later have
    std::vector<ObstaclePair> pairs;
  } skin;
  Positions last;  ///< the cloth at the last search

  /// Refers to the surface.
  ClothSearch(const Surface& cloth, bool self_contact, BroadPhaseKind kind);
  /// Bounds a motion of the cloth by boxes and tree, as SweptBoxes::update.
  void update(const Positions& x0, const Positions& x1, double margin, const Eigen::RowVector3d& origin);
  /// Sets `pairs` to those of find_obstacle_pairs for the motion, beside obstacles in swept `boxes`, without
  /// a search among boxes where the skin has them: a skin that is worn out is made again at `pose`, if it
  /// would last. Returns false otherwise, and where the motion may have more than `row_limit` rows. The
  /// motion's d̂ may be larger than `dhat`.
  bool find_in_skin(const LinearMotion& motion, const SweptBoxes& boxes, const ObstacleTree& pose,
                    double dhat, long row_limit);
};

}  // namespace drape::ipc
