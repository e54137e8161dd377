#include "plugins/contact/ipc/bound_ipc.h"

#include <algorithm>
#include <limits>

#include "core/numerics/collision_detection/intersections.h"
#include "core/numerics/collision_detection/surface_search.h"
#include "core/numerics/contact/additive_ccd.h"
#include "core/numerics/contact/rim_contacts.h"
#include "core/numerics/contact/surface_contacts.h"
#include "plugins/contact/ipc/obstacle_trajectory.h"

namespace drape::ipc {
namespace {

constexpr long unlimited = std::numeric_limits<long>::max();

// Limits on the pairs of one step, of swept boxes and of primitives.
constexpr long box_pairs_each = 48, primitive_pairs_each = 16;  // per cloth triangle
constexpr long min_counted_triangles = 1000;                    // a cloth counts as having at least these
constexpr long dense_factor = 3;                                // over the pairs at x0
/// A step with more pairs is shortened to this fraction, again and again; after so many tries it is not
/// searched at all.
constexpr double shortening = 0.25;
constexpr int max_tries = 20;

const BoundIpc& as_ipc(const BoundContact& contact) {
  const auto* own = dynamic_cast<const BoundIpc*>(&contact);
  if (!own) throw std::runtime_error("obstacles of \"ipc\" cannot replace those of another contact model");
  return *own;
}

}  // namespace

/// The candidates of a linear motion, by use.
class BoundIpc::Candidates final : public CollisionCandidates {
 public:
  /// `found` has the pairs of the motion from x0 to x1, which is a fraction of the requested one.
  Candidates(const BoundIpc& contact, Positions x0, Positions x1, double fraction,
             std::vector<ContactPair> found)
      : contact_(contact),
        x0_(std::move(x0)),
        x1_(std::move(x1)),
        fraction_(fraction),
        vertex_triangles_(surface_candidates(found, contact.cloth_)) {
    for (ContactPair& pair : found) {
      if (pair.obstacle < 0) pair.dhat = contact.rest_->layers.dhat_of(pair);
      const bool has_barrier = pair.weight > 0 && pair.dhat > 0;
      (!has_barrier ? ccd_only_ : pair.at_rim ? rims_ : barrier_).push_back(pair);
    }
  }

  StepLimit max_step() const override {
    StepLimit limit;
    for (const std::vector<ContactPair>* pairs : {&barrier_, &rims_, &ccd_only_}) {
      const SafeFraction safe = additive_ccd(x0_, x1_, obstacles(), *pairs, contact_.p_.min_gap_fraction);
      if (safe.fraction < limit.fraction) limit = {safe.fraction, name((*pairs)[safe.blocking])};
    }
    if (fraction_ < 1 && limit.fraction == 1) limit.by = "the limit on candidate pairs of one step";
    limit.fraction *= fraction_;
    return limit;
  }

  std::unique_ptr<Collisions> build_collisions(const Positions& x) const override {
    const BarrierParameters& barrier = contact_.barrier_;
    return make_collisions(
        barrier,
        find_surface_contacts(x, *contact_.obstacles_, contact_.tree_.get()->dihedrals, vertex_triangles_,
                              contact_.cloth_.vertex_area, contact_.p_.friction, barrier.dhat),
        find_rim_contacts(x, obstacles(), rims_), find_pair_contacts(x, obstacles(), barrier_));
  }

  /// At x0, over all pairs but neighbours, whose d̂ is 0: on vertices of CCD-only pairs with an obstacle the
  /// surface's barrier acts.
  SmallestGap smallest_gap() const {
    SmallestGap smallest;
    const ContactPair* nearest = nullptr;
    for (const std::vector<ContactPair>* pairs : {&barrier_, &rims_, &ccd_only_})
      for (const ContactPair& pair : *pairs) {
        if (!is_within_dhat(pair, positions_of(pair, x0_, obstacles()))) continue;
        const double gap = PairContact(pair, x0_, obstacles()).gap();
        if (gap >= smallest.gap) continue;
        smallest.gap = gap;
        nearest = &pair;
      }
    if (nearest) smallest.between = name(*nearest);
    return smallest;
  }

 private:
  const Positions& obstacles() const { return contact_.obstacles_->vertices; }
  std::string name(const ContactPair& pair) const {
    return name_of(pair.vertices, pair.kind, *contact_.obstacles_, static_cast<int>(x0_.rows()));
  }

  const BoundIpc& contact_;
  Positions x0_, x1_;  // the part of the motion that was searched
  double fraction_;    // of the requested motion
  // Pairs with a barrier, pairs at rims with theirs (RimContact), and pairs for CCD only.
  std::vector<ContactPair> barrier_, rims_, ccd_only_;
  // Cloth vertices with the obstacle triangles that may contribute to their barrier.
  std::vector<VertexTriangleCandidate> vertex_triangles_;
};

RestCloth::RestCloth(const Level& level, const Ipc::Parameters& p)
    : dhat(p.dhat),
      self_contact(p.self_contact),
      broad_phase(p.broad_phase),
      surface(Surface::of(level.rest, level.topology)),
      search(surface, self_contact, broad_phase) {
  if (self_contact) layers = RestLayers::of(surface, level, dhat);
}

BoundIpc::BoundIpc(const Ipc::Parameters& parameters, const BarrierParameters& barrier,
                   std::shared_ptr<const Obstacles> obstacles, Deferred<ObstacleTree> tree,
                   std::shared_ptr<const RestCloth> rest)
    : p_(parameters),
      barrier_(barrier),
      obstacles_(std::move(obstacles)),
      tree_(std::move(tree)),
      rest_(std::move(rest)),
      cloth_(rest_->surface) {}

std::shared_ptr<const BoundContact> BoundIpc::with_stiffness(double stiffness) const {
  if (barrier_.stiffness_is_fixed) return nullptr;
  BarrierParameters barrier = barrier_;
  barrier.stiffness = stiffness;
  return std::make_shared<const BoundIpc>(p_, barrier, obstacles_, tree_, rest_);
}

bool BoundIpc::search(const Positions& x0, const Positions& x1, const PairLimits& limits,
                      std::vector<ContactPair>& found, long& boxes) const {
  const LinearMotion motion{x0, x1, barrier_.dhat, obstacles_->vertices, obstacles_->vertices};
  ClothSearch& own = rest_->search;
  found.clear();
  boxes = 0;
  if (own.self && !own.self->find(motion, p_.friction, limits, boxes, found)) return false;
  if (obstacles_->bodies.empty()) return true;
  const std::shared_ptr<const ObstacleTree> other = tree_.get();
  const long row_limit = limits.boxes - boxes, pair_limit = limits.primitives - std::ssize(found);
  // Without limits the number of boxes is asked for, which a skin does not know.
  if (limits.boxes != unlimited && own.find_in_skin(motion, other->boxes, *other, barrier_.dhat, row_limit)) {
    if (std::ssize(own.pairs) > pair_limit) return false;
  } else {
    own.update(x0, x1, 0.5 * barrier_.dhat, other->origin);
    if (!own.tree->overlaps(*other->tree, row_limit, own.rows)) return false;
    boxes += std::ssize(own.rows.items);
    if (!find_obstacle_pairs(own.boxes, other->boxes, own.rows, motion, pair_limit, own.pairs)) return false;
  }
  append_contact_pairs(own.pairs, cloth_, *obstacles_, other->dihedrals, barrier_.dhat, p_.friction, found);
  return true;
}

std::unique_ptr<CollisionCandidates> BoundIpc::build_candidates(const Positions& x0,
                                                                const Positions& x1) const {
  const std::lock_guard lock(rest_->search.busy);
  const long size = std::max<long>(cloth_.triangle_count(), min_counted_triangles);
  PairLimits limits{box_pairs_each * size, primitive_pairs_each * size};
  std::vector<ContactPair> found;
  long boxes = 0;
  Positions end = x1;
  double fraction = 1;
  for (int tries = 1; !search(x0, end, limits, found, boxes); ++tries) {
    if (tries == 1) {  // a dense scene has many pairs at x0 already
      search(x0, x0, {unlimited, unlimited}, found, boxes);
      const PairLimits default_limits = limits;
      limits = {std::max(limits.boxes, dense_factor * boxes),
                std::max(limits.primitives, dense_factor * std::ssize(found))};
      if (limits != default_limits) continue;
    }
    fraction = tries < max_tries ? shortening * fraction : 0;
    if (tries >= max_tries) limits = {unlimited, unlimited};
    end = fraction > 0 ? Positions(x0 + fraction * (x1 - x0)) : x0;
  }
  return std::make_unique<Candidates>(*this, x0, std::move(end), fraction, std::move(found));
}

SmallestGap BoundIpc::smallest_gap(const Positions& x) const {
  return static_cast<const Candidates&>(*build_candidates(x, x)).smallest_gap();
}

std::vector<ObstacleGap> BoundIpc::obstacle_gaps(const Positions& x) const {
  const TriangleMesh cloth{x, cloth_.triangles};
  const SurfaceSearch near_cloth(cloth);
  std::vector<ObstacleGap> gaps;
  for (const Obstacle& body : obstacles_->bodies) {
    const Eigen::Vector3d connection = shortest_connection(near_cloth, SurfaceSearch(body.mesh()));
    gaps.push_back({body.name, connection.norm(), connection.normalized(), true});
  }
  return gaps;
}

StepLimit BoundIpc::max_step(const BoundContact& before, const Positions& x) const {
  const BoundIpc& from = as_ipc(before);
  if (from.obstacles_ == obstacles_) return {};
  const std::lock_guard lock(rest_->search.busy);
  return max_trajectory_step(*from.tree_.get(), obstacles_, rest_->search, x, barrier_.dhat);
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
  if (p_.self_contact)
    for (const TrianglePair& pair : self_intersections(cloth))
      found.push_back({"cloth triangle " + std::to_string(pair.first),
                       "cloth triangle " + std::to_string(pair.second),
                       pair.where,
                       {pair.first, pair.second}});
  std::vector<std::pair<const Obstacle*, int>> owners;  // of each triangle of all, with its number there
  for (const Obstacle& body : obstacles_->bodies)
    for (int t = 0; t < body.triangles().rows(); ++t) owners.emplace_back(&body, t);
  std::vector<TrianglePair> pairs =
      drape::intersections(cloth, {obstacles_->vertices, obstacles_->topology->triangles});
  std::ranges::stable_sort(pairs, {}, [&](const TrianglePair& pair) { return owners[pair.second].first; });
  for (const TrianglePair& pair : pairs) {
    const auto [body, number] = owners[pair.second];
    found.push_back({"cloth triangle " + std::to_string(pair.first),
                     body->name + " triangle " + std::to_string(number),
                     pair.where,
                     {pair.first, -1}});
  }
  return found;
}

std::vector<TriangleMesh> BoundIpc::obstacles() const {
  std::vector<TriangleMesh> meshes;
  for (const Obstacle& body : obstacles_->bodies) meshes.push_back(body.mesh());
  return meshes;
}

}  // namespace drape::ipc
