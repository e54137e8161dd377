#include "core/kernel/interfaces/energy.h"
#include "core/kernel/plugin/plugin.h"

namespace {

/// The energy on one level: E(x) = ½ k Σ m_i (z_i − z0)².
class BoundSpringToPlane : public drape::BoundEnergy {
 public:
  BoundSpringToPlane(double height, Eigen::VectorXd spring_constants)
      : height_(height), spring_constants_(std::move(spring_constants)) {}

  double value(const drape::Positions& x) const override {
    return 0.5 * spring_constants_.dot(offsets(x).cwiseAbs2());
  }

  double add_gradient(const drape::Positions& x, drape::Positions& g) const override {
    g.col(2) += spring_constants_.cwiseProduct(offsets(x));
    return value(x);
  }

  // One element a vertex, and the vertex is all of its stencil.
  drape::Stencils stencils() const override {
    return Eigen::VectorXi::LinSpaced(spring_constants_.size(), 0, spring_constants_.size() - 1);
  }

  // Never negative, so there is nothing to project.
  void add_hessian(const drape::Positions&, drape::Projection, drape::BlockSink& sink) const override {
    for (int i = 0; i < spring_constants_.size(); ++i) {
      const double block[9] = {0, 0, 0, 0, 0, 0, 0, 0, spring_constants_[i]};
      sink.add(i, 0, 0, block);
    }
  }

 private:
  Eigen::VectorXd offsets(const drape::Positions& x) const { return x.col(2).array() - height_; }

  double height_;                     // z0 [m]
  Eigen::VectorXd spring_constants_;  // k m_i [N/m]
};

/// Springs that pull every vertex towards a horizontal plane, in proportion to its mass.
class SpringToPlane : public drape::Energy {
 public:
  struct Parameters {
    double stiffness = 100;
    double height = 0;

    static void declare(drape::Declaration<Parameters>& d) {
      d.add("stiffness", &Parameters::stiffness)
          .unit("1/s²")
          .above(0)
          .at_most(1e9)
          .description("k: spring constant of a unit of mass");
      d.add("height", &Parameters::height)
          .unit("m")
          .at_least(-1e3)
          .at_most(1e3)
          .description("z0: height of the plane");
    }
  };

  explicit SpringToPlane(const Parameters& parameters) : p_(parameters) {}

  drape::EnergyRole role() const override { return drape::EnergyRole::position; }

  std::unique_ptr<drape::BoundEnergy> bind(const drape::Level& level,
                                           const drape::Material& material) const override {
    const double k = p_.stiffness * material.area_density();
    return std::make_unique<BoundSpringToPlane>(p_.height, k * level.vertex_area);
  }

 private:
  Parameters p_;
};

}  // namespace

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, SpringToPlane>("spring_to_plane", "Springs to a horizontal plane.");
}
