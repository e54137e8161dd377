#include "plugins/contact/ipc/bound_ipc.h"

#include <algorithm>
#include <limits>

#include "core/numerics/collision_detection/intersections.h"
#include "core/numerics/collision_detection/surface_gap.h"
#include "core/numerics/contact/contact_kernel.h"
#include "core/numerics/contact/contact_stack.h"
#include "core/numerics/contact/rim_contacts.h"
#include "core/numerics/contact/surface_contacts.h"
#include "plugins/contact/ipc/obstacle_trajectory.h"

namespace drape::ipc {
namespace {

constexpr long unlimited = std::numeric_limits<long>::max();

// Limits on the pairs of one step (README.md, "Long steps").
constexpr long box_pairs_each = 48, primitive_pairs_each = 16;  // per cloth triangle
constexpr long min_counted_triangles = 1000;                    // the cloth counts as having so many
constexpr long dense_factor = 3;                                // over the pairs at x0
/// A step with more pairs is shortened to this fraction, again and again; after so many tries it is not
/// searched at all.
constexpr double shortening = 0.25;
constexpr int max_tries = 20;

std::unique_ptr<SelfPairSearch> make_self_search(bool self_contact, const Surface& cloth,
                                                 BroadPhaseKind kind) {
  return self_contact ? std::make_unique<SelfPairSearch>(cloth, kind) : nullptr;
}

const BoundIpc& as_ipc(const BoundContact& contact) {
  const auto* own = dynamic_cast<const BoundIpc*>(&contact);
  if (!own) throw std::runtime_error("obstacles of \"ipc\" cannot replace those of another contact model");
  return *own;
}

/// The candidates of a linear motion.
class IpcCandidates final : public CollisionCandidates {
 public:
  IpcCandidates(Positions x0, Positions x1, double fraction, ClassifiedPairs found,
                std::shared_ptr<const ObstacleTree> tree, std::shared_ptr<const RestCloth> rest,
                const BarrierParameters& barrier, double friction, double min_gap_fraction)
      : x0_(std::move(x0)),
        x1_(std::move(x1)),
        fraction_(fraction),
        found_(std::move(found)),
        tree_(std::move(tree)),
        obstacles_(*tree_->obstacles),
        rest_(std::move(rest)),
        barrier_(barrier),
        friction_(friction),
        min_gap_fraction_(min_gap_fraction) {}

  StepLimit max_step() const override {
    StepLimit limit{1, ""};
    for (const std::vector<ContactPair>* pairs : {&found_.barrier, &found_.rims, &found_.ccd_only}) {
      int blocking = -1;
      const double part = additive_ccd(x0_, x1_, obstacles_.vertices, *pairs, min_gap_fraction_, blocking);
      if (part < limit.fraction)
        limit = {part,
                 blocking < 0 ? "" : name_of((*pairs)[blocking], obstacles_, static_cast<int>(x0_.rows()))};
    }
    if (fraction_ < 1 && limit.fraction == 1) limit.by = "the limit on candidate pairs of one step";
    limit.fraction *= fraction_;
    return limit;
  }

  std::unique_ptr<Collisions> build_collisions(const Positions& x) const override {
    auto pairs = make_pair_contacts(x, obstacles_.vertices, found_.barrier, barrier_);
    if (found_.vertex_triangles.empty() && found_.rims.empty()) return pairs;
    std::vector<std::unique_ptr<Collisions>> sets;
    sets.push_back(
        make_surface_contacts(SurfaceContacts::of(x, obstacles_, tree_->coefficients, found_.vertex_triangles,
                                                  rest_->surface.vertex_area, friction_, barrier_.dhat),
                              barrier_));
    if (!found_.rims.empty())
      sets.push_back(make_rim_contacts(x, obstacles_.vertices, found_.rims, barrier_));
    sets.push_back(std::move(pairs));
    return std::make_unique<CollisionStack>(std::move(sets));
  }

  /// At x0, over the pairs with a barrier.
  SmallestGap smallest_gap() const {
    const int n = static_cast<int>(x0_.rows());
    SmallestGap smallest;
    smallest.dhat = barrier_.dhat;
    smallest.stiffness = barrier_.stiffness;
    const ContactPair* nearest = nullptr;
    const auto visit = [&](const ContactPair& pair) {
      const PairPositions at = positions_of(pair, x0_, obstacles_.vertices);
      if (!is_within_dhat(pair, at)) return;
      const double gap = contact_at(pair, at).gap();
      if (gap >= smallest.gap) return;
      smallest.gap = gap;
      nearest = &pair;
    };
    for (const ContactPair& pair : found_.barrier) visit(pair);
    for (const ContactPair& pair : found_.rims) visit(pair);
    // The surface's barrier acts on the vertices of CCD-only pairs with an obstacle.
    for (const ContactPair& pair : found_.ccd_only)
      if (pair.vertices[0] >= n || pair.vertices[3] >= n) visit(pair);
    if (nearest) smallest.between = name_of(*nearest, obstacles_, n);
    return smallest;
  }

 private:
  Positions x0_, x1_;  // the part of the motion that was searched
  double fraction_;    // of the requested motion
  ClassifiedPairs found_;
  std::shared_ptr<const ObstacleTree> tree_;
  const Obstacles& obstacles_;
  std::shared_ptr<const RestCloth> rest_;
  BarrierParameters barrier_;
  double friction_, min_gap_fraction_;
};

}  // namespace

std::shared_ptr<const RestCloth> RestCloth::of(const Level& level, double dhat, bool self_contact) {
  auto cloth =
      std::make_shared<RestCloth>(RestCloth{dhat, self_contact, Surface::of(level.rest, level.topology), {}});
  if (self_contact) cloth->layers = RestLayers::of(cloth->surface, level, dhat);
  return cloth;
}

std::shared_ptr<const ObstacleTree> ObstacleTree::of(const std::shared_ptr<const Obstacles>& obstacles,
                                                     double dhat, BroadPhaseKind kind) {
  auto tree = std::make_shared<ObstacleTree>(
      ObstacleTree{obstacles,
                   {},
                   OperatorCoefficients::of(obstacles->surface, obstacles->dihedrals, dhat),
                   make_broad_phase(kind)});
  tree->boxes.update(obstacles->surface, obstacles->vertices, obstacles->vertices, 0.5 * dhat);
  tree->tree->update(tree->boxes.triangles);
  return tree;
}

BoundIpc::BoundIpc(const Ipc::Parameters& p, std::shared_ptr<const ObstacleTree> obstacles,
                   std::shared_ptr<const RestCloth> rest, const Material& material)
    : friction_(p.friction),
      min_gap_fraction_(p.min_gap_fraction),
      self_contact_(p.self_contact),
      barrier_(p.barrier(material)),
      obstacle_tree_(std::move(obstacles)),
      obstacles_(obstacle_tree_->obstacles),
      rest_(std::move(rest)),
      cloth_(rest_->surface),
      broad_phase_(p.broad_phase),
      self_search_(make_self_search(self_contact_, cloth_, broad_phase_)),
      cloth_tree_(make_broad_phase(p.broad_phase)) {}

BoundIpc::BoundIpc(const BoundIpc& other, double stiffness)
    : friction_(other.friction_),
      min_gap_fraction_(other.min_gap_fraction_),
      self_contact_(other.self_contact_),
      barrier_(other.barrier_),
      obstacle_tree_(other.obstacle_tree_),
      obstacles_(other.obstacles_),
      rest_(other.rest_),
      cloth_(rest_->surface),
      broad_phase_(other.broad_phase_),
      self_search_(make_self_search(self_contact_, cloth_, broad_phase_)),
      cloth_tree_(make_broad_phase(broad_phase_)) {
  barrier_.stiffness = stiffness;
}

std::shared_ptr<const BoundContact> BoundIpc::with_stiffness(double stiffness) const {
  return barrier_.stiffness_is_fixed ? nullptr : std::make_shared<const BoundIpc>(*this, stiffness);
}

bool BoundIpc::search(const Positions& x0, const Positions& x1, const PairCounts& limits,
                      BroadPhasePairs& found, PairCounts& counts) const {
  const LinearMotion motion{x0, x1, barrier_.dhat, obstacles_->vertices, obstacles_->vertices};
  found.clear();
  counts = {};
  if (self_search_ && !self_search_->find(motion, friction_, limits, counts, found)) return false;
  if (obstacles_->bodies.empty()) return true;
  boxes_.update(cloth_, x0, x1, 0.5 * barrier_.dhat);
  cloth_tree_->update(boxes_.triangles);
  if (!cloth_tree_->overlaps(*obstacle_tree_->tree, limits.boxes - counts.boxes, rows_)) return false;
  counts.boxes += static_cast<long>(rows_.items.size());
  if (!find_obstacle_pairs(cloth_, boxes_, *obstacles_, obstacle_tree_->boxes, rows_, motion, friction_,
                           limits.primitives, found))
    return false;
  counts.primitives = found.count();
  return true;
}

std::unique_ptr<CollisionCandidates> BoundIpc::build_candidates(const Positions& x0,
                                                                const Positions& x1) const {
  const std::lock_guard lock(busy_);
  const long size = std::max<long>(cloth_.triangle_count(), min_counted_triangles);
  PairCounts limits{box_pairs_each * size, primitive_pairs_each * size}, counts;
  BroadPhasePairs found;
  Positions end = x1;
  double fraction = 1;
  for (int tries = 1; !search(x0, end, limits, found, counts); ++tries) {
    if (tries == 1) {  // a dense scene has many pairs at x0 already
      search(x0, x0, {unlimited, unlimited}, found, counts);
      const PairCounts default_limits = limits;
      limits = {std::max(limits.boxes, dense_factor * counts.boxes),
                std::max(limits.primitives, dense_factor * counts.primitives)};
      if (!(limits == default_limits)) continue;
    }
    fraction = tries < max_tries ? shortening * fraction : 0;
    if (tries >= max_tries) limits = {unlimited, unlimited};
    end = fraction > 0 ? Positions(x0 + fraction * (x1 - x0)) : x0;
  }
  ClassifiedPairs candidates{std::move(found.pairs), {}, {}, std::move(found.vertex_triangles)};
  std::vector<ContactPair>& pairs = candidates.barrier;
  for (ContactPair& pair : pairs)
    if (pair.obstacle < 0) pair.dhat = rest_->layers.dhat_of(pair.vertices);
  const auto ccd_only = std::stable_partition(
      pairs.begin(), pairs.end(), [](const ContactPair& pair) { return pair.weight > 0 && pair.dhat > 0; });
  candidates.ccd_only.assign(ccd_only, pairs.end());
  pairs.erase(ccd_only, pairs.end());
  const auto rims =
      std::stable_partition(pairs.begin(), pairs.end(), [](const ContactPair& pair) { return !pair.at_rim; });
  candidates.rims.assign(rims, pairs.end());
  pairs.erase(rims, pairs.end());
  return std::make_unique<IpcCandidates>(x0, std::move(end), fraction, std::move(candidates), obstacle_tree_,
                                         rest_, barrier_, friction_, min_gap_fraction_);
}

SmallestGap BoundIpc::smallest_gap(const Positions& x) const {
  return static_cast<const IpcCandidates&>(*build_candidates(x, x)).smallest_gap();
}

std::vector<ObstacleGap> BoundIpc::obstacle_gaps(const Positions& x) const {
  const TriangleMesh cloth{x, cloth_.triangles};
  std::vector<ObstacleGap> gaps;
  for (const Obstacle& body : obstacles_->bodies) {
    const Eigen::Vector3d connection = shortest_connection(cloth, body.mesh);
    gaps.push_back({body.name, connection.norm(), connection.normalized()});
  }
  return gaps;
}

StepLimit BoundIpc::max_step(const BoundContact& before, const Positions& x) const {
  const Obstacles& from = *as_ipc(before).obstacles_;
  if (&from == obstacles_.get()) return {};
  return max_trajectory_step(from, *obstacles_, cloth_, x, barrier_.dhat, broad_phase_);
}

Eigen::Vector3d BoundIpc::displacement(const BoundContact& before, const ObstaclePoint& point) const {
  const Positions &from = as_ipc(before).obstacles_->vertices, &to = obstacles_->vertices;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k)
    if (const int v = point.vertices[k]; v >= 0)
      sum += point.weights[k] * (to.row(v) - from.row(v)).transpose();
  return sum;
}

std::vector<Intersection> BoundIpc::intersections(const Positions& x) const {
  const TriangleMesh cloth{x, cloth_.triangles};
  std::vector<Intersection> found;
  if (self_contact_)
    for (const TrianglePair& pair : self_intersections(cloth))
      found.push_back({"cloth triangle " + std::to_string(pair.first),
                       "cloth triangle " + std::to_string(pair.second), pair.where});
  for (const Obstacle& body : obstacles_->bodies)
    for (const TrianglePair& pair : drape::intersections(cloth, body.mesh))
      found.push_back({"cloth triangle " + std::to_string(pair.first),
                       body.name + " triangle " + std::to_string(pair.second), pair.where});
  return found;
}

std::vector<TriangleMesh> BoundIpc::obstacles() const {
  std::vector<TriangleMesh> meshes;
  for (const Obstacle& body : obstacles_->bodies) meshes.push_back(body.mesh);
  return meshes;
}

}  // namespace drape::ipc
