#include "plugins/contact/ipc/cloth_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace drape::ipc {
namespace {

/// The margin of a skin [d̂]: a wider one lasts longer, and has more pairs.
constexpr double skin_margin = 2;
/// A skin is made where it would serve this many searches that move as far as the last one.
constexpr double least_searches = 6;

/// The largest distance of a vertex in two places [m].
double largest_distance(const Positions& a, const Positions& b) {
  return &a == &b || a.rows() == 0 ? 0 : std::sqrt((a - b).rowwise().squaredNorm().maxCoeff());
}

}  // namespace

ObstacleTree::ObstacleTree(std::shared_ptr<const Obstacles> all, double dhat, PoseTrees& trees)
    : obstacles(std::move(all)),
      origin(Eigen::RowVector3d::Zero()),
      boxes(*obstacles->topology),
      dihedrals(*obstacles) {
  if (obstacles->vertices.rows() > 0) origin = obstacles->vertices.colwise().mean();
  boxes.update(obstacles->vertices, obstacles->vertices, 0.5 * dhat, origin);
  tree = trees.of(boxes.triangles);
}

ClothSearch::ClothSearch(const Surface& cloth, bool self_contact, BroadPhaseKind kind)
    : self(self_contact ? std::make_unique<SelfPairSearch>(cloth, kind) : nullptr),
      boxes(cloth),
      tree(make_broad_phase(kind)) {}

void ClothSearch::update(const Positions& x0, const Positions& x1, double margin,
                         const Eigen::RowVector3d& origin) {
  boxes.update(x0, x1, margin, origin);
  tree->update(boxes.triangles);
}

bool ClothSearch::find_in_skin(const LinearMotion& motion, const SweptBoxes& obstacles,
                               const ObstacleTree& pose, double dhat, long row_limit) {
  const Positions& at = pose.obstacles->vertices;
  // Primitives approach each other by at most twice what their vertices move.
  const double moved = 2 * largest_distance(motion.x0, motion.x1) +
                       2 * largest_distance(motion.obstacles0, motion.obstacles1) + (motion.dhat - dhat);
  const auto moved_from = [&](const Positions& cloth, const Positions& others) {
    return moved + largest_distance(cloth, motion.x0) + largest_distance(others, motion.obstacles0);
  };
  const auto serves = [&] {
    return skin.obstacles && skin.obstacles->topology == pose.obstacles->topology &&
           skin.row_count <= row_limit && moved_from(skin.cloth, skin.obstacles->vertices) <= skin.margin;
  };
  if (last.rows() == 0) last = motion.x0;
  const double margin = skin_margin * dhat;
  if (!serves()) {
    const bool lasts = moved_from(last, at) <= margin / least_searches;
    last = motion.x0;
    if (!lasts) return false;
    update(motion.x0, motion.x0, 0.5 * dhat + margin, pose.origin);
    if (!tree->overlaps(*pose.tree, row_limit, rows)) return false;
    find_obstacle_pairs(boxes, pose.boxes, rows, {motion.x0, motion.x0, dhat + margin, at, at},
                        std::numeric_limits<long>::max(), skin.pairs);
    const auto extent = [&](const Positions& of) {
      return (of.rowwise() - pose.origin).cwiseAbs().maxCoeff();
    };
    // Boxes round to floats.
    skin.margin = 0.99 * margin - 1e-6 * std::max(extent(motion.x0), extent(at));
    skin.row_count = std::ssize(rows.items);
    skin.cloth = motion.x0;
    skin.obstacles = pose.obstacles;
    if (!serves()) return false;
  }
  last = motion.x0;
  boxes.update(motion.x0, motion.x1, 0.5 * dhat, pose.origin);
  pairs = obstacle_pairs_among(skin.pairs, boxes, obstacles, motion);
  return true;
}

}  // namespace drape::ipc
