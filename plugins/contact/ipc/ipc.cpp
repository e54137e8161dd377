#include "plugins/contact/ipc/ipc.h"

#include <algorithm>

#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/plugin.h"
#include "plugins/contact/ipc/bound_ipc.h"
#include "plugins/contact/ipc/weak_cache.h"

namespace drape::ipc {

void Ipc::Parameters::declare(Declaration<Parameters>& d) {
  using P = Parameters;
  d.add("self_contact", &P::self_contact).description("whether the cloth collides with itself");
  d.add_sections("obstacles", &P::obstacles).description("triangle meshes that the cloth collides with");
  d.add("friction", &P::friction)
      .unit("1")
      .at_least(0)
      .at_most(bounds::largest_friction)
      .description("Coulomb's friction coefficient μ, for self-contact and for obstacles without their own");
  d.add("dhat", &P::dhat)
      .unit("m")
      .at_least(bounds::smallest_length)
      .at_most(1e3)
      .description("barrier activation distance d̂: the barrier acts on smaller gaps")
      .formerly("range")
      .source("docs/theory/method.md, section 6");
  d.add("stiffness", &P::stiffness)
      .unit("Pa")
      .at_least(1e-9)
      .at_most(bounds::largest_modulus)
      .description(
          "barrier stiffness κ: the barrier's pressure is κ |b'(gap / d̂)|; null: ten times the cloth's "
          "weight per area")
      .source("core/kernel/contact/stiffness.h");
  d.add("friction_smoothing_distance", &P::friction_smoothing_distance)
      .unit("m")
      .at_least(1e-12)
      .at_most(1e3)
      .description("ε_v h: friction is smoothed at smaller tangential displacements, where a contact sticks")
      .formerly("slip_distance")
      .source("Li et al. 2020, eq. 14");
  d.add("min_gap_fraction", &P::min_gap_fraction)
      .unit("1")
      .at_least(1e-6)
      .at_most(0.99)
      .description("fraction of every gap that a step must leave: s of additive CCD")
      .formerly("keep")
      .source("Li et al. 2021");
  d.add_choice("broad_phase", &P::broad_phase,
               {{"bvh", BroadPhaseKind::bvh}, {"fcl", BroadPhaseKind::fcl}, {"cgal", BroadPhaseKind::cgal}})
      .description(
          "broad phase algorithm: own BVH, FCL's, or CGAL's box intersection; the pairs are the same");
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
