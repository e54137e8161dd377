#include "plugins/contact/ipc/ipc.h"

#include <algorithm>

#include "core/kernel/plugin/plugin.h"
#include "plugins/contact/ipc/bound_ipc.h"
#include "plugins/contact/ipc/weak_cache.h"

namespace drape::ipc {

void Ipc::Parameters::declare(Declaration<Parameters>& d) {
  using P = Parameters;
  d.add("self_contact", &P::self_contact).description("whether the cloth collides with itself");
  d.add_sections("obstacles", &P::obstacles).description("triangle meshes that the cloth collides with");
  declare_contact_parameters(d);
  d.add_choice("broad_phase", &P::broad_phase, {{"bvh", BroadPhaseKind::bvh}, {"fcl", BroadPhaseKind::fcl}})
      .description("broad phase algorithm: own BVH or FCL's; the pairs are the same");
}

Ipc::Ipc(const Parameters& parameters) : p_(parameters) {
  static WeakCache<Obstacles> all;
  int levels = 1;
  for (const ObstacleParameters& p : p_.obstacles) levels = std::max(levels, p.cages.count + 1);
  for (int level = 0; level < levels; ++level) {
    std::vector<Obstacle> bodies;
    for (const ObstacleParameters& p : p_.obstacles)
      bodies.push_back(Obstacle::of(p, static_cast<int>(bodies.size()), level));
    obstacles_.push_back(all.find_or_make([&](const Obstacles& made) { return made.bodies == bodies; },
                                          [&] { return Obstacles::of(bodies); }));
  }
}

std::unique_ptr<BoundContact> Ipc::bind(const Level& level, const Material& material) const {
  if (!p_.self_contact && p_.obstacles.empty()) return nullptr;
  return std::make_unique<BoundIpc>(p_, obstacles_[std::min<std::size_t>(level.index, obstacles_.size() - 1)],
                                    level, material);
}

}  // namespace drape::ipc

DRAPE_PLUGIN(registry) {
  registry.add<drape::ContactModel, drape::ipc::Ipc>(
      "ipc", "IPC's barrier and friction, for self-contact and triangle-mesh obstacles.");
}
