#include "plugins/contact/ipc/bound_ipc.h"

#include <algorithm>
#include <limits>

#include "core/contact/pair_geometry.h"
#include "core/contact/stiffness.h"
#include "core/mesh/intersections.h"

namespace drape {
namespace {

constexpr long unlimited = std::numeric_limits<long>::max();

/// Found pairs along a way, and the names of what they are made of.
class IpcSweep final : public ContactSweep {
 public:
  IpcSweep(Positions x0, Positions x1, double fraction, Candidates found,
           std::shared_ptr<const Obstacles> obstacles, const BarrierParameters& barrier, double keep)
      : x0_(std::move(x0)),
        x1_(std::move(x1)),
        fraction_(fraction),
        found_(std::move(found)),
        obstacles_(std::move(obstacles)),
        barrier_(barrier),
        keep_(keep) {}

  StepLimit max_step() const override {
    StepLimit limit{1, ""};
    for (const std::vector<ContactPair>* pairs : {&found_.repelling, &found_.passive}) {
      int blocking = -1;
      const double part = additive_ccd(x0_, x1_, obstacles_->vertices, *pairs, keep_, blocking);
      if (part < limit.fraction) limit = {part, blocking < 0 ? "" : name((*pairs)[blocking])};
    }
    if (fraction_ < 1 && limit.fraction == 1)
      limit.by = "the number of pairs that a longer way may bring together";
    limit.fraction *= fraction_;
    return limit;
  }

  std::unique_ptr<ContactSet> build(const Positions& x) const override {
    return make_pair_contacts(x, obstacles_->vertices, found_.repelling, barrier_);
  }

 private:
  std::string name(const ContactPair& pair) const {
    const auto& v = pair.vertices;
    if (pair.kind == PairKind::edge_edge)
      return name("edge", {v[0], v[1]}) + " and " + name("edge", {v[2], v[3]});
    return name("vertex", {v[0]}) + " and " + name("triangle", {v[1], v[2], v[3]});
  }

  std::string name(const std::string& primitive, const std::vector<int>& vertices) const {
    const int n = static_cast<int>(x0_.rows()), body = obstacles_->body_of(vertices[0] - n);
    const bool of_cloth = vertices[0] < n;
    const int first = of_cloth ? 0 : n + obstacles_->first_vertex[body];
    std::string text = (of_cloth ? "cloth" : obstacles_->bodies[body].name) + " " + primitive;
    for (std::size_t k = 0; k < vertices.size(); ++k)
      text += (k == 0 ? " " : "–") + std::to_string(vertices[k] - first);
    return text;
  }

  Positions x0_, x1_;  // of the way as far as it was searched
  double fraction_;    // of the way that was asked for
  Candidates found_;
  std::shared_ptr<const Obstacles> obstacles_;
  BarrierParameters barrier_;
  double keep_;
};

}  // namespace

BoundIpc::BoundIpc(const Ipc::Parameters& p, std::shared_ptr<const Obstacles> obstacles, const Level& level,
                   const Material& material)
    : friction_(p.friction),
      keep_(p.keep),
      self_contact_(p.self_contact),
      barrier_{p.range, p.stiffness.value_or(contact_stiffness(material)), p.slip_distance},
      obstacles_(std::move(obstacles)),
      cloth_(Surface::of(level.rest, level.topology)),
      obstacle_tree_(make_broad_phase(p.broad_phase)),
      cloth_tree_(make_broad_phase(p.broad_phase)) {
  obstacle_boxes_.update(obstacles_->surface, obstacles_->vertices, obstacles_->vertices, 0.5 * p.range);
  obstacle_tree_->update(obstacle_boxes_.triangles);
  if (self_contact_) remember_close_at_rest(level.rest.vertices);
}

void BoundIpc::remember_close_at_rest(const Positions& rest) {
  const Way still{rest, rest, barrier_.range};
  boxes_.update(cloth_, rest, rest, 0.5 * barrier_.range);
  cloth_tree_->update(boxes_.triangles);
  cloth_tree_->overlaps(unlimited, rows_);
  std::vector<ContactPair> pairs;
  find_self_pairs(cloth_, boxes_, rows_, still, friction_, unlimited, pairs);
  for (const ContactPair& pair : pairs) close_at_rest_.push_back(pair.vertices);
  std::sort(close_at_rest_.begin(), close_at_rest_.end());
}

bool BoundIpc::search(const Positions& x0, const Positions& x1, const Counts& limits,
                      std::vector<ContactPair>& pairs, Counts& counts) const {
  const Way way{x0, x1, barrier_.range};
  pairs.clear();
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
                         find_self_pairs(cloth_, boxes_, rows_, way, friction_, limits.primitives, pairs)))
    return false;
  if (!obstacles_->bodies.empty() && !(list_rows(x1, obstacle_tree_.get()) &&
                                       find_obstacle_pairs(cloth_, boxes_, *obstacles_, obstacle_boxes_,
                                                           rows_, way, friction_, limits.primitives, pairs)))
    return false;
  counts.primitives = static_cast<long>(pairs.size());
  return true;
}

std::unique_ptr<ContactSweep> BoundIpc::sweep(const Positions& x0, const Positions& x1) const {
  const std::lock_guard lock(busy_);
  const long size = std::max(cloth_.triangle_count(), 1000);
  Counts limits{48 * size, 16 * size}, counts;
  Candidates found;
  Positions end = x1;
  double fraction = 1;
  for (int tries = 1; !search(x0, end, limits, found.repelling, counts); ++tries) {
    if (tries == 1) {  // where much is near already, three times that is reasonable
      search(x0, x0, {unlimited, unlimited}, found.repelling, counts);
      const Counts usual = limits;
      limits = {std::max(limits.triangles, 3 * counts.triangles),
                std::max(limits.primitives, 3 * counts.primitives)};
      if (!(limits == usual)) continue;
    }
    fraction = tries < 20 ? 0.25 * fraction : 0;
    if (tries >= 20) limits = {unlimited, unlimited};
    end = fraction > 0 ? Positions(x0 + fraction * (x1 - x0)) : x0;
  }
  if (!close_at_rest_.empty()) {
    const auto middle = std::stable_partition(
        found.repelling.begin(), found.repelling.end(), [this](const ContactPair& pair) {
          return !std::binary_search(close_at_rest_.begin(), close_at_rest_.end(), pair.vertices);
        });
    found.passive.assign(middle, found.repelling.end());
    found.repelling.erase(middle, found.repelling.end());
  }
  return std::make_unique<IpcSweep>(x0, std::move(end), fraction, std::move(found), obstacles_, barrier_,
                                    keep_);
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
