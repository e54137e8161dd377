#include "core/kernel/contact/contact_parameters.h"
#include "core/kernel/contact/vertex_contacts.h"
#include "core/kernel/plugin/plugin.h"

namespace {

using drape::Positions;

struct FloorParameters : drape::ContactParameters {
  double height = 0;

  static void declare(drape::Declaration<FloorParameters>& d) {
    d.add("height", &FloorParameters::height)
        .unit("m")
        .at_least(-1e3)
        .at_most(1e3)
        .description("z of the floor");
    declare_contact_parameters(d);
  }
  double gap(const Positions& x, int i) const { return x(i, 2) - height; }
};

/// The cloth above the floor during one motion.
struct FloorCandidates : drape::CollisionCandidates {
  FloorParameters floor;
  drape::BarrierParameters barrier;
  Eigen::VectorXd area;  // of each vertex [m²]
  Positions x0, x1;

  drape::StepLimit max_step() const override {
    drape::StepLimit limit;
    for (int i = 0; i < x0.rows(); ++i) {
      const double usable = (1 - floor.min_gap_fraction) * floor.gap(x0, i), descent = x0(i, 2) - x1(i, 2);
      if (limit.fraction * descent > usable)
        limit = {usable / descent, "cloth vertex " + std::to_string(i) + " and the floor"};
    }
    return limit;
  }
  std::unique_ptr<drape::Collisions> build_collisions(const Positions& x) const override {
    std::vector<drape::VertexContact> contacts;
    for (int i = 0; i < x.rows(); ++i)
      if (floor.gap(x, i) < floor.dhat)
        contacts.push_back({i, 0, area[i], floor.friction, {floor.gap(x, i)}});
    return make_vertex_contacts(std::move(contacts), barrier);
  }
};

struct BoundFloor : drape::BoundContact {
  FloorCandidates at_rest;

  std::unique_ptr<drape::CollisionCandidates> build_candidates(const Positions& x0,
                                                               const Positions& x1) const override {
    auto candidates = std::make_unique<FloorCandidates>(at_rest);
    candidates->x0 = x0;
    candidates->x1 = x1;
    return candidates;
  }
  std::vector<drape::Intersection> intersections(const Positions& x) const override {
    std::vector<drape::Intersection> found;
    for (int i = 0; i < x.rows(); ++i)
      if (at_rest.floor.gap(x, i) <= 0)
        found.push_back({"cloth vertex " + std::to_string(i), "the floor", x.row(i).transpose()});
    return found;
  }
  std::vector<drape::TriangleMesh> obstacles() const override { return {}; }
};

/// A floor that vertices rest on.
struct Floor : drape::ContactModel {
  using Parameters = FloorParameters;
  Parameters parameters;

  explicit Floor(const Parameters& p) : parameters(p) {}
  std::unique_ptr<drape::BoundContact> bind(const drape::Level& level,
                                            const drape::Material& material) const override {
    auto bound = std::make_unique<BoundFloor>();
    bound->at_rest.floor = parameters;
    bound->at_rest.barrier = parameters.barrier(material);
    bound->at_rest.area = level.vertex_area;
    return bound;
  }
};

}  // namespace

DRAPE_PLUGIN(registry) {
  registry.add<drape::ContactModel, Floor>("floor", "A horizontal floor under the vertices.");
}
