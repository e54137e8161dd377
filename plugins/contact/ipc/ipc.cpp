#include "plugins/contact/ipc/ipc.h"

#include <algorithm>

#include "core/plugin/bounds.h"
#include "core/plugin/plugin.h"
#include "plugins/contact/ipc/bound_ipc.h"
#include "plugins/contact/ipc/kept.h"

namespace drape {

void Ipc::Parameters::declare(Declaration<Parameters>& d) {
  using P = Parameters;
  d.add("self_contact", &P::self_contact).description("keep the cloth apart from itself");
  d.add_sections("obstacles", &P::obstacles).description("meshes in the cloth's way");
  d.add("friction", &P::friction)
      .unit("1")
      .at_least(0)
      .at_most(bounds::largest_friction)
      .description("Coulomb's μ, of the cloth against itself and against obstacles without their own");
  d.add("range", &P::range)
      .unit("m")
      .at_least(bounds::smallest_length)
      .at_most(1e3)
      .description("distance d̂ below which the barrier acts")
      .source("docs/method.md, section 6");
  d.add("stiffness", &P::stiffness)
      .unit("Pa")
      .at_least(1e-9)
      .at_most(bounds::largest_modulus)
      .description(
          "κ: pressure of the barrier is κ |b'(distance / d̂)|; null chooses it from the cloth's weight")
      .source("core/contact/stiffness.h");
  d.add("slip_distance", &P::slip_distance)
      .unit("m")
      .at_least(1e-12)
      .at_most(1e3)
      .description("a contact that has slid less than this sticks: friction is smoothed below")
      .source("Li et al. 2020, equation 14: ε_v h");
  d.add("keep", &P::keep)
      .unit("1")
      .at_least(1e-6)
      .at_most(0.99)
      .description("part of every gap that a step leaves")
      .source("Li et al. 2021, additive CCD");
  d.add_choice("broad_phase", &P::broad_phase,
               {{"bvh", BroadPhaseKind::bvh}, {"fcl", BroadPhaseKind::fcl}, {"cgal", BroadPhaseKind::cgal}})
      .description("how near pairs are looked for: own tree, FCL's or CGAL's; they find the same");
}

Ipc::Ipc(const Parameters& parameters) : p_(parameters) {
  static Kept<Obstacles> all;
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

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::ContactModel, drape::Ipc>(
      "ipc", "IPC's barrier and friction: the cloth against itself and against triangle meshes.");
}
