#include "core/kernel/plugin/plugin.h"
#include "core/numerics/contact/contact_parameters.h"
#include "core/numerics/contact/vertex_contacts.h"

namespace {

using drape::Positions;

/// The floor and what a level's cloth brings.
struct Floor {
  double height;  // [m]
  drape::ContactParameters p;
  drape::BarrierParameters barrier;
  Eigen::VectorXd area;  // of each vertex [m²]

  double gap(const Positions& x, int i) const { return x(i, 2) - height; }
};

struct FloorCandidates : drape::CollisionCandidates {
  FloorCandidates(const Floor& floor, const Positions& x0, const Positions& x1)
      : floor(floor), x0(x0), x1(x1) {}

  drape::StepLimit max_step() const override {
    drape::StepLimit limit;
    for (int i = 0; i < x0.rows(); ++i) {
      const double usable = (1 - floor.p.min_gap_fraction) * floor.gap(x0, i), descent = x0(i, 2) - x1(i, 2);
      if (limit.fraction * descent > usable)
        limit = {usable / descent, "cloth vertex " + std::to_string(i) + " and the floor"};
    }
    return limit;
  }
  std::unique_ptr<drape::Collisions> build_collisions(const Positions& x) const override {
    std::vector<drape::VertexContact> contacts;
    for (int i = 0; i < x.rows(); ++i)
      if (const double gap = floor.gap(x, i); gap < floor.p.dhat)
        contacts.push_back({i, 0, floor.area[i], floor.p.friction, {gap}});
    return make_collisions(floor.barrier, std::move(contacts));
  }

  const Floor& floor;
  const Positions x0, x1;
};

struct BoundFloor : drape::BoundContact {
  explicit BoundFloor(Floor f) : floor(std::move(f)) {}

  std::unique_ptr<drape::CollisionCandidates> build_candidates(const Positions& x0,
                                                               const Positions& x1) const override {
    return std::make_unique<FloorCandidates>(floor, x0, x1);
  }
  std::vector<drape::Intersection> intersections(const Positions& x) const override {
    std::vector<drape::Intersection> found;
    for (int i = 0; i < x.rows(); ++i)
      if (floor.gap(x, i) <= 0)
        found.push_back({"cloth vertex " + std::to_string(i), "the floor", x.row(i).transpose()});
    return found;
  }

  const Floor floor;
};

/// A floor that vertices rest on.
struct FloorModel : drape::ContactModel, drape::ContactParameters {
  double height = 0;

  static void declare(drape::Declaration<FloorModel>& d) {
    d.add("height", &FloorModel::height, "z of the floor").unit("m").between(-1e3, 1e3);
    declare_contact_parameters(d);
  }

  std::unique_ptr<drape::BoundContact> bind(const drape::Level& level,
                                            const drape::Material& material) const override {
    return std::make_unique<BoundFloor>(Floor{height, *this, barrier(material), level.vertex_area});
  }
};

}  // namespace

DRAPE_PLUGIN(registry) {
  registry.add<drape::ContactModel, FloorModel>("floor", "A horizontal floor under the vertices.");
}
