#include "plugins/contact/ipc/bound_ipc.h"

#include <algorithm>
#include <limits>

#include "core/contact/contact_kernel.h"
#include "core/contact/contact_stack.h"
#include "core/contact/mean_moves.h"
#include "core/contact/stiffness.h"
#include "core/mesh/intersections.h"
#include "core/mesh/same_triangles.h"
#include "plugins/contact/ipc/kept.h"
#include "plugins/contact/ipc/obstacle_way.h"
#include "plugins/contact/ipc/surface_contacts.h"

namespace drape {
namespace {

constexpr long unlimited = std::numeric_limits<long>::max();

const BoundIpc& own_kind(const BoundContact& contact) {
  const auto* own = dynamic_cast<const BoundIpc*>(&contact);
  if (!own) throw std::runtime_error("obstacles of \"ipc\" cannot come from those of another contact model");
  return *own;
}

std::vector<std::array<int, 4>> close_at_rest(const Surface& cloth, const Positions& rest, double range) {
  const Positions none;
  SweptBoxes boxes;
  boxes.update(cloth, rest, rest, 0.5 * range);
  const auto tree = make_broad_phase(BroadPhaseKind::bvh);
  tree->update(boxes.triangles);
  AdjacencyList rows;
  // Of triangles: some ten times what a cloth of 200K vertices has with a range of its edges' length.
  constexpr long most_pairs = 50'000'000;
  if (!tree->overlaps(most_pairs, rows))
    throw std::runtime_error(
        "contact \"ipc\": more than 50 million pairs of the resting cloth's triangles are "
        "within \"range\" of each other; lower it to about the length of an edge");
  FoundPairs found;
  find_self_pairs(cloth, boxes, rows, {rest, rest, range, none, none}, 0, unlimited, found);
  std::vector<std::array<int, 4>> close;
  for (const ContactPair& pair : found.pairs) close.push_back(pair.vertices);
  std::sort(close.begin(), close.end());
  return close;
}

/// Found pairs along a way, and the names of what they are made of.
class IpcSweep final : public ContactSweep {
 public:
  IpcSweep(Positions x0, Positions x1, double fraction, Candidates found,
           std::shared_ptr<const ObstacleTree> tree, std::shared_ptr<const RestingCloth> rest,
           const BarrierParameters& barrier, double friction, double keep)
      : x0_(std::move(x0)),
        x1_(std::move(x1)),
        fraction_(fraction),
        found_(std::move(found)),
        tree_(std::move(tree)),
        obstacles_(*tree_->obstacles),
        rest_(std::move(rest)),
        barrier_(barrier),
        friction_(friction),
        keep_(keep) {}

  StepLimit max_step() const override {
    StepLimit limit{1, ""};
    for (const std::vector<ContactPair>* pairs : {&found_.repelling, &found_.passive}) {
      int blocking = -1;
      const double part = additive_ccd(x0_, x1_, obstacles_.vertices, *pairs, keep_, blocking);
      if (part < limit.fraction)
        limit = {part,
                 blocking < 0 ? "" : name_of((*pairs)[blocking], obstacles_, static_cast<int>(x0_.rows()))};
    }
    if (fraction_ < 1 && limit.fraction == 1)
      limit.by = "the number of pairs that a longer way may bring together";
    limit.fraction *= fraction_;
    return limit;
  }

  std::unique_ptr<ContactSet> build(const Positions& x) const override {
    auto pairs = make_pair_contacts(x, obstacles_.vertices, found_.repelling, barrier_);
    if (found_.near.empty()) return pairs;
    std::vector<std::unique_ptr<ContactSet>> sets;
    sets.push_back(
        make_surface_contacts(SurfaceContacts::of(x, obstacles_, tree_->coefficients, found_.near,
                                                  rest_->surface.vertex_area, friction_, barrier_.range),
                              barrier_));
    sets.push_back(std::move(pairs));
    return std::make_unique<ContactStack>(std::move(sets));
  }

  /// At the way's beginning, of the pairs that have a barrier.
  SmallestGap smallest_gap() const {
    const int n = static_cast<int>(x0_.rows());
    SmallestGap smallest;
    smallest.range = barrier_.range;
    smallest.stiffness = barrier_.stiffness;
    const ContactPair* nearest = nullptr;
    const auto look_at = [&](const ContactPair& pair) {
      const PairPositions at = positions_of(pair, x0_, obstacles_.vertices);
      if (!within_range(pair, at, barrier_.range)) return;
      const double gap = contact_at(pair, at, barrier_.range).gap();
      if (gap >= smallest.gap) return;
      smallest.gap = gap;
      nearest = &pair;
    };
    for (const ContactPair& pair : found_.repelling) look_at(pair);
    for (const ContactPair& pair : found_.passive)  // of an obstacle: what is near a vertex repels it
      if (pair.vertices[0] >= n || pair.vertices[3] >= n) look_at(pair);
    if (nearest) smallest.between = name_of(*nearest, obstacles_, n);
    return smallest;
  }

 private:
  Positions x0_, x1_;  // of the way as far as it was searched
  double fraction_;    // of the way that was asked for
  Candidates found_;
  std::shared_ptr<const ObstacleTree> tree_;
  const Obstacles& obstacles_;
  std::shared_ptr<const RestingCloth> rest_;
  BarrierParameters barrier_;
  double friction_, keep_;
};

}  // namespace

std::shared_ptr<const RestingCloth> RestingCloth::of(const Level& level, double range, bool self_contact) {
  static Kept<RestingCloth> all;
  const TriangleMesh& rest = level.rest;
  return all.find_or_make(
      [&](const RestingCloth& cloth) {
        return cloth.range == range && cloth.self_contact == self_contact &&
               cloth.rest.vertices.rows() == rest.vertices.rows() && cloth.rest.vertices == rest.vertices &&
               same_triangles(cloth.rest.triangles, rest.triangles);
      },
      [&] {
        RestingCloth cloth{rest, range, self_contact, Surface::of(rest, level.topology), {}};
        if (self_contact) cloth.close = close_at_rest(cloth.surface, rest.vertices, range);
        return cloth;
      });
}

std::shared_ptr<const ObstacleTree> ObstacleTree::of(std::shared_ptr<const Obstacles> obstacles, double range,
                                                     BroadPhaseKind kind) {
  static Kept<ObstacleTree> all;
  return all.find_or_make(
      [&](const ObstacleTree& tree) {
        return tree.obstacles == obstacles && tree.range == range && tree.kind == kind;
      },
      [&] {
        ObstacleTree tree{obstacles,
                          range,
                          kind,
                          {},
                          OperatorCoefficients::of(obstacles->surface, obstacles->dihedrals, range),
                          make_broad_phase(kind)};
        tree.boxes.update(obstacles->surface, obstacles->vertices, obstacles->vertices, 0.5 * range);
        tree.tree->update(tree.boxes.triangles);
        return tree;
      });
}

BoundIpc::BoundIpc(const Ipc::Parameters& p, std::shared_ptr<const Obstacles> obstacles, const Level& level,
                   const Material& material)
    : friction_(p.friction),
      keep_(p.keep),
      self_contact_(p.self_contact),
      barrier_{p.range, p.stiffness.value_or(contact_stiffness(material)), p.slip_distance},
      obstacles_(std::move(obstacles)),
      obstacle_tree_(ObstacleTree::of(obstacles_, p.range, p.broad_phase)),
      rest_(RestingCloth::of(level, p.range, p.self_contact)),
      cloth_(rest_->surface),
      broad_phase_(p.broad_phase),
      cloth_tree_(make_broad_phase(p.broad_phase)) {}

bool BoundIpc::search(const Positions& x0, const Positions& x1, const Counts& limits, FoundPairs& found,
                      Counts& counts) const {
  const Way way{x0, x1, barrier_.range, obstacles_->vertices, obstacles_->vertices};
  found.clear();
  counts = {};
  const auto list_rows = [&](const Positions& end, const BroadPhase* obstacle_tree) {
    boxes_.update(cloth_, x0, end, 0.5 * barrier_.range);
    cloth_tree_->update(boxes_.triangles);
    const long limit = limits.triangles - counts.triangles;
    if (!(obstacle_tree ? cloth_tree_->overlaps(*obstacle_tree, limit, rows_)
                        : cloth_tree_->overlaps(limit, rows_)))
      return false;
    counts.triangles += static_cast<long>(rows_.items.size());
    return true;
  };
  // What all of the cloth does together brings nothing of it nearer to the rest.
  if (self_contact_ && !(list_rows(x1.rowwise() - (x1 - x0).colwise().mean(), nullptr) &&
                         find_self_pairs(cloth_, boxes_, rows_, way, friction_, limits.primitives, found)))
    return false;
  if (!obstacles_->bodies.empty() && !(list_rows(x1, obstacle_tree_->tree.get()) &&
                                       find_obstacle_pairs(cloth_, boxes_, *obstacles_, obstacle_tree_->boxes,
                                                           rows_, way, friction_, limits.primitives, found)))
    return false;
  counts.primitives = found.count();
  return true;
}

std::unique_ptr<ContactSweep> BoundIpc::sweep(const Positions& x0, const Positions& x1) const {
  const std::lock_guard lock(busy_);
  const long size = std::max(cloth_.triangle_count(), 1000);
  Counts limits{48 * size, 16 * size}, counts;
  FoundPairs found;
  Positions end = x1;
  double fraction = 1;
  for (int tries = 1; !search(x0, end, limits, found, counts); ++tries) {
    if (tries == 1) {  // where much is near already, three times that is reasonable
      search(x0, x0, {unlimited, unlimited}, found, counts);
      const Counts usual = limits;
      limits = {std::max(limits.triangles, 3 * counts.triangles),
                std::max(limits.primitives, 3 * counts.primitives)};
      if (!(limits == usual)) continue;
    }
    fraction = tries < 20 ? 0.25 * fraction : 0;
    if (tries >= 20) limits = {unlimited, unlimited};
    end = fraction > 0 ? Positions(x0 + fraction * (x1 - x0)) : x0;
  }
  Candidates candidates{std::move(found.pairs), {}, std::move(found.near)};
  std::vector<ContactPair>& pairs = candidates.repelling;
  const auto passive = std::stable_partition(pairs.begin(), pairs.end(), [this](const ContactPair& pair) {
    return pair.weight > 0 && !std::binary_search(rest_->close.begin(), rest_->close.end(), pair.vertices);
  });
  candidates.passive.assign(passive, pairs.end());
  pairs.erase(passive, pairs.end());
  return std::make_unique<IpcSweep>(x0, std::move(end), fraction, std::move(candidates), obstacle_tree_,
                                    rest_, barrier_, friction_, keep_);
}

SmallestGap BoundIpc::smallest_gap(const Positions& x) const {
  return static_cast<const IpcSweep&>(*sweep(x, x)).smallest_gap();
}

StepLimit BoundIpc::max_move(const BoundContact& before, const Positions& x) const {
  const Obstacles& from = *own_kind(before).obstacles_;
  if (&from == obstacles_.get()) return {};
  return ObstacleWay(from, *obstacles_).max_move(cloth_, x, barrier_.range, broad_phase_);
}

void BoundIpc::carry(const BoundContact& before, const Positions& x, Positions& from) const {
  const BoundIpc& was = own_kind(before);
  if (was.obstacles_ == obstacles_) return;
  const int n = static_cast<int>(x.rows());
  FoundPairs found;
  {
    Counts counts;
    const std::lock_guard lock(was.busy_);
    was.search(x, x, {unlimited, unlimited}, found, counts);
  }
  MeanMoves moves(n);  // by friction's force
  const Positions by = obstacles_->vertices - was.obstacles_->vertices;
  const auto surface = SurfaceContacts::of(x, *was.obstacles_, was.obstacle_tree_->coefficients, found.near,
                                           was.cloth_.vertex_area, was.friction_, was.barrier_.range);
  for (const SurfaceContact& contact : surface.contacts) {
    const std::vector<double> pressures = surface.pressures(contact, was.barrier_.range);
    for (int i = contact.first; i < contact.last; ++i) {
      const NearestFeature& f = surface.features[i];
      Eigen::Vector3d move = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k)
        if (f.vertices[k] >= 0) move += f.weights[k] * by.row(f.vertices[k]).transpose();
      moves.add(contact.vertex, move, f.friction * pressures[i - contact.first]);
    }
  }
  for (const ContactPair& pair : found.pairs) {
    const auto is_cloth = [&](int k) { return pair.vertices[k] < n; };
    if ((is_cloth(0) && is_cloth(3)) || pair.weight == 0 || pair.friction == 0) continue;
    const PairPositions at = positions_of(pair, x, was.obstacles_->vertices);
    if (!within_range(pair, at, was.barrier_.range)) continue;
    const Contact contact = contact_at(pair, at, was.barrier_.range);
    const PairPositions move = positions_of(pair, x, obstacles_->vertices) - at;
    const Eigen::Vector3d of_obstacle = move * contact.closest.c.cwiseAbs();  // the cloth's columns are zero
    for (int k = 0; k < 4; ++k)
      if (is_cloth(k))
        moves.add(pair.vertices[k], of_obstacle,
                  std::abs(contact.closest.c[k]) * pair.friction * contact.pressure());
  }
  moves.move(from);
}

std::vector<Touch> BoundIpc::intersections(const Positions& x) const {
  const TriangleMesh cloth{x, cloth_.triangles};
  std::vector<Touch> touches;
  if (self_contact_)
    for (const TrianglePair& pair : self_intersections(cloth))
      touches.push_back({"cloth triangle " + std::to_string(pair.first),
                         "cloth triangle " + std::to_string(pair.second), pair.where});
  for (const Obstacle& body : obstacles_->bodies)
    for (const TrianglePair& pair : drape::intersections(cloth, body.mesh))
      touches.push_back({"cloth triangle " + std::to_string(pair.first),
                         body.name + " triangle " + std::to_string(pair.second), pair.where});
  return touches;
}

std::vector<TriangleMesh> BoundIpc::obstacles() const {
  std::vector<TriangleMesh> meshes;
  for (const Obstacle& body : obstacles_->bodies) meshes.push_back(body.mesh);
  return meshes;
}

}  // namespace drape
