#include "plugins/contact/ipc/ipc.h"

#include <algorithm>
#include <stdexcept>

#include "core/kernel/files/message_text.h"
#include "core/kernel/plugin/plugin.h"
#include "core/kernel/plugin/refused_parameters.h"
#include "plugins/contact/ipc/bound_ipc.h"

namespace drape::ipc {

namespace {

constexpr double most_triangles = 5e6;  ///< of all obstacles; each takes some 500 bytes and 1 µs

void refuse_too_many(double triangles) {
  if (triangles > most_triangles)
    throw std::runtime_error("with this one the obstacles have " + three_digits(triangles / 1e6) +
                             " million triangles, and at most " + three_digits(most_triangles / 1e6) +
                             " million are taken; simplify their meshes, or lower \"subdivisions\"");
}

}  // namespace

void Ipc::Parameters::declare(Declaration<Parameters>& d) {
  using P = Parameters;
  d.add("self_contact", &P::self_contact, "whether the cloth collides with itself");
  declare_obstacles(d).description("triangle meshes that the cloth collides with");
  declare_contact_parameters(d);
  d.add_choice("broad_phase", &P::broad_phase, {{"bvh", BroadPhaseKind::bvh}, {"fcl", BroadPhaseKind::fcl}},
               "broad phase algorithm: own BVH or FCL's; the pairs are the same");
}

Ipc::Ipc(const Parameters& parameters, const Ipc* before) : p_(parameters) {
  std::size_t levels = 1;
  double triangles = 0;  // of all obstacles together
  for_all_items("obstacles", p_.obstacles, [&](const ObstacleParameters& p, std::size_t k) {
    if (triangles > most_triangles) return;  // an obstacle before this one is refused
    const bool same =
        before && k < before->meshes_.size() && ObstacleMeshes::are_same(p, before->p_.obstacles[k]);
    meshes_.push_back(same ? before->meshes_[k] : ObstacleMeshes::of(p, static_cast<int>(k)));
    refuse_too_many(triangles += static_cast<double>(meshes_.back().frames[0]->mesh.triangles.rows()));
    levels = std::max<std::size_t>(levels, p.cages.count + 1);
  });
  for (std::size_t level = 0; level < levels; ++level) {
    std::vector<Obstacle> bodies;
    for_all_items("obstacles", p_.obstacles, [&](const ObstacleParameters& p, std::size_t k) {
      bodies.push_back(Obstacle::of(p, static_cast<int>(k), meshes_[k], static_cast<int>(level)));
    });
    levels_.push_back(level_obstacles(std::move(bodies), before));
  }
}

Ipc::LevelObstacles Ipc::level_obstacles(std::vector<Obstacle> bodies, const Ipc* before) const {
  const LevelObstacles* last =
      before && levels_.size() < before->levels_.size() ? &before->levels_[levels_.size()] : nullptr;
  const auto share_triangles = [](const Obstacle& a, const Obstacle& b) {
    return a.geometry.frames[0] == b.geometry.frames[0];
  };
  const bool same_triangles = last && std::ranges::equal(last->bodies, bodies, share_triangles),
             same = last && last->bodies == bodies,
             same_kind = last && before->p_.broad_phase == p_.broad_phase;
  const auto topology =
      same_triangles ? last->topology : Deferred<ObstacleTopology>([bodies] { return topology_of(bodies); });
  const auto trees = same_triangles && same_kind ? last->trees : std::make_shared<PoseTrees>(p_.broad_phase);
  const auto obstacles =
      same ? last->obstacles
           : Deferred<Obstacles>([bodies, topology] { return Obstacles::of(bodies, topology.get()); });
  const auto tree = same && same_kind && before->p_.dhat == p_.dhat
                        ? last->tree
                        : Deferred<ObstacleTree>([obstacles, trees, dhat = p_.dhat] {
                            return ObstacleTree(obstacles.get(), dhat, *trees);
                          });
  return {std::move(bodies), topology, trees, obstacles, tree};
}

std::unique_ptr<BoundContact> Ipc::bind(const Level& level, const Material& material,
                                        std::shared_ptr<const RestCloth> rest) const {
  const LevelObstacles& own = levels_[std::min<std::size_t>(level.index, levels_.size() - 1)];
  return std::make_unique<BoundIpc>(p_, p_.barrier(material), own.obstacles.get(), own.tree, std::move(rest));
}

std::unique_ptr<BoundContact> Ipc::bind(const Level& level, const Material& material) const {
  if (!p_.self_contact && p_.obstacles.empty()) return nullptr;
  return bind(level, material, std::make_shared<const RestCloth>(level, p_));
}

std::unique_ptr<BoundContact> Ipc::rebind(const Level& level, const Material& material,
                                          const BoundContact& before) const {
  const std::shared_ptr<const RestCloth>& rest = dynamic_cast<const BoundIpc&>(before).rest();
  if (!rest->serves(p_)) return bind(level, material);
  return bind(level, material, rest);
}

std::vector<std::string> Ipc::input_remarks() const {
  std::vector<std::string> remarks;
  for (const ObstacleMeshes& meshes : meshes_)
    if (!meshes.repair.empty()) remarks.push_back(meshes.repair);
  return remarks;
}

}  // namespace drape::ipc

DRAPE_PLUGIN(registry) {
  registry.add<drape::ContactModel, drape::ipc::Ipc>(
      "ipc", "IPC's barrier and friction, for self-contact and triangle-mesh obstacles.");
}
