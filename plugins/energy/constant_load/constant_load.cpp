#include <vector>

#include "core/kernel/interfaces/energy.h"
#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/parameters.h"
#include "core/kernel/plugin/plugin.h"
#include "core/numerics/collision_detection/point_tree.h"
#include "core/numerics/elements/linear_energy.h"

namespace drape {

/// Constant forces: E = -Σ f_i · x_i.
class ConstantLoad final : public Energy {
 public:
  /// A force on the vertex nearest to `point` in the rest shape.
  struct PointForce {
    Eigen::Vector3d point{0, 0, 0};
    Eigen::Vector3d force{0, 0, 0};
    static void declare(Declaration<PointForce>& d) {
      d.add("point", &PointForce::point, "point in the rest shape; the nearest vertex receives the force")
          .unit("m")
          .between(-bounds::largest_coordinate, bounds::largest_coordinate)
          .required();
      d.add("force", &PointForce::force, "total force")
          .unit("N")
          .between(-bounds::largest_load, bounds::largest_load)
          .required();
    }
  };

  Eigen::Vector3d force_density{0, 0, 0};
  std::vector<PointForce> points;

  static void declare(Declaration<ConstantLoad>& d) {
    d.add("force_density", &ConstantLoad::force_density, "force per rest area on the whole cloth")
        .unit("N/m²")
        .between(-bounds::largest_load, bounds::largest_load);
    d.add_sections("points", &ConstantLoad::points, "forces on single vertices");
  }

  EnergyRole role() const override { return EnergyRole::external; }
  /// On a finer mesh another vertex may be nearest to a point.
  std::optional<double> midpoint_factor() const override {
    return points.empty() ? std::optional(1.0) : std::nullopt;
  }
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material&) const override {
    Positions forces = level.vertex_area * force_density.transpose();
    const PointTree vertices(level.rest.vertices, points.size());
    for (const PointForce& load : points) forces.row(vertices.nearest(load.point)) += load.force.transpose();
    return std::make_unique<LinearEnergy>(std::move(forces));
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::ConstantLoad>("constant_load",
                                                   "Constant forces: by rest area, and on single vertices.");
}
