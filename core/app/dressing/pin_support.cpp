#include "core/app/dressing/pin_support.h"

#include <algorithm>

#include "core/app/dressing/load_forces.h"
#include "core/app/scene/vertex_search.h"

namespace drape {

namespace {

constexpr double unsupported = 0.02;  // garments sink and rise again by so much while they are sewn [m]

/// The vertices of a pin on a level.
struct Supported {
  std::vector<int> vertices;
  Eigen::VectorXd shares;  ///< w [1], their sum is 1
  double height = 0;       ///< m₀ [m]
};

class BoundPinSupport final : public BoundEnergy {
 public:
  BoundPinSupport(std::vector<Supported> pins, Eigen::RowVector3d up, double stiffness)
      : pins_(std::move(pins)), up_(std::move(up)), stiffness_(stiffness) {}

  double value(const Positions& x) const override {
    double sum = 0;
    for (const Supported& pin : pins_) sum += stiffness_ / 2 * std::pow(sunk(pin, x), 2);
    return sum;
  }

  double add_gradient(const Positions& x, Positions& g) const override {
    for (const Supported& pin : pins_) {
      const double force = stiffness_ * sunk(pin, x);
      for (std::size_t k = 0; k < pin.vertices.size(); ++k)
        g.row(pin.vertices[k]) -= force * pin.shares[static_cast<Eigen::Index>(k)] * up_;
    }
    return value(x);
  }

  Stencils stencils() const override {
    std::vector<int> all;
    for (const Supported& pin : pins_) all.insert(all.end(), pin.vertices.begin(), pin.vertices.end());
    return Eigen::Map<const Eigen::VectorXi>(all.data(), static_cast<Eigen::Index>(all.size()));
  }

  void add_hessian(const Positions& x, Projection, BlockSink& sink) const override {
    int element = 0;
    for (const Supported& pin : pins_) {
      const bool acts = sunk(pin, x) > 0;
      for (const double share : pin.shares) {
        const Eigen::Matrix3d block = (acts ? stiffness_ * share : 0) * up_.transpose() * up_;
        sink.add(element++, 0, 0, block.data());
      }
    }
  }

 private:
  /// How far a pin's vertices are below where they are supported [m].
  double sunk(const Supported& pin, const Positions& x) const {
    double height = 0;
    for (std::size_t k = 0; k < pin.vertices.size(); ++k)
      height += pin.shares[static_cast<Eigen::Index>(k)] * x.row(pin.vertices[k]).dot(up_);
    return std::max(0.0, pin.height - height);
  }

  const std::vector<Supported> pins_;
  const Eigen::RowVector3d up_;
  const double stiffness_;  // k [N/m]
};

class PinSupport final : public Energy {
 public:
  PinSupport(const DressingSetup& setup, Eigen::RowVector3d up)
      : pins_(setup.experiment.parameters.pins),
        coarsest_(setup.scene.hierarchy.levels[0]),
        placed_(setup.start->placed),
        up_(std::move(up)) {}

  EnergyRole role() const override { return EnergyRole::position; }

  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override {
    const VertexSearch search(level, coarsest_, pins_.size()), coarse(coarsest_, coarsest_, pins_.size());
    std::vector<Supported> pins;
    for (const PinParameters& pin : pins_) {
      Supported own = supported(search.selected(pin), level);
      const Supported placed = supported(coarse.selected(pin), coarsest_);
      own.height = (placed_(placed.vertices, Eigen::all) * up_.transpose()).dot(placed.shares) - unsupported;
      pins.push_back(std::move(own));
    }
    return std::make_unique<BoundPinSupport>(std::move(pins), up_,
                                             material.mean_membrane_modulus() * material.thickness);
  }

 private:
  static Supported supported(std::vector<int> vertices, const Level& level) {
    const Eigen::VectorXd areas = level.vertex_area(vertices);
    return {std::move(vertices), areas / areas.sum()};
  }

  const std::vector<PinParameters> pins_;
  const Level& coarsest_;
  const Positions placed_;
  const Eigen::RowVector3d up_;
};

}  // namespace

std::shared_ptr<const Energy> pin_support(const DressingSetup& setup) {
  const Positions& placed = setup.start->placed;
  if (setup.experiment.parameters.pins.empty() || placed.rows() == 0) return nullptr;
  const auto up = upward(load_forces(setup.experiment, setup.scene.hierarchy.levels[0], placed));
  return up ? std::make_shared<PinSupport>(setup, *up) : nullptr;
}

}  // namespace drape
