#include "core/kernel/interfaces/energy.h"
#include "core/kernel/plugin/parameters.h"
#include "core/kernel/plugin/plugin.h"
#include "core/numerics/elements/orthotropic_stiffness.h"
#include "plugins/energy/midedge_bending/bound_midedge_bending.h"

namespace drape {

/// Kirchhoff–Love plate bending from normals at edge midpoints, for any triangulation and rest shape: Σ_t Ā k
/// ((1 - ν) tr S² + ν (tr S)²), k = E_bend d³ / (24 (1 - ν²)).
class MidedgeBending final : public Energy {
 public:
  double correction_tolerance = 0.02, sliding_curvature = 5;

  static void declare(Declaration<MidedgeBending>& d) {
    d.add("correction_tolerance", &MidedgeBending::correction_tolerance,
          "smallest weight with which a neighbouring dihedral angle corrects an edge's normal, where "
          "the triangles about the edge differ; with 1 normals are plain averages of the triangles'")
        .between(0, 1);
    d.add("sliding_curvature", &MidedgeBending::sliding_curvature,
          "κ0, curvature at which friction between yarns has 71 % of its moment; of cloth with "
          "`bending_hysteresis`")
        .unit("1/m")
        .between(1e-3, 1e3);
  }

  EnergyRole role() const override { return EnergyRole::bending; }
  double plate_stiffness(const Material& material) const override { return 2 * bending_stiffness(material); }
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override {
    return bind_sharp(level, material, {});
  }
  std::unique_ptr<BoundEnergy> bind_sharp(const Level& level, const Material& material,
                                          const Eigen::VectorXd& sharpness) const override {
    return std::make_unique<BoundMidedgeBending>(level,
                                                 ShapeOperators::of(level, material, correction_tolerance),
                                                 BendingFriction::of(material, sliding_curvature), sharpness);
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::MidedgeBending>(
      "midedge_bending", "Bending of a plate by normals at edges, on any triangulation, any rest shape.");
}
