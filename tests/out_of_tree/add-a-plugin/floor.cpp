#include "core/kernel/contact/barrier.h"
#include "core/kernel/contact/stiffness.h"
#include "core/kernel/model/contact_model.h"
#include "core/kernel/plugin/plugin.h"

namespace {

/// The floor's parameters.
struct Floor {
  double height = 0, dhat = 1e-3;  // z of the floor, d̂ [m]
  Eigen::VectorXd stiffness;       // κ times the area of each vertex [N]

  double gap(const drape::Positions& x, int i) const { return x(i, 2) - height; }
};

/// The vertices within d̂ at one state, with the barrier κ A_i d̂ b(gap / d̂).
class FloorCollisions : public drape::Collisions {
 public:
  FloorCollisions(const Floor& floor, const drape::Positions& x) : floor_(floor) {
    for (int i = 0; i < x.rows(); ++i)
      if (floor.gap(x, i) < floor.dhat) {
        vertices_.push_back(i);
        smallest_gap_ = std::min(smallest_gap_, floor.gap(x, i));
      }
  }

  double value(const drape::Positions& x) const override {
    double sum = 0;
    for (const int i : vertices_) sum += floor_.stiffness[i] * floor_.dhat * at(x, i).value;
    return sum;
  }
  double add_gradient(const drape::Positions& x, drape::Positions& g) const override {
    for (const int i : vertices_) g(i, 2) += floor_.stiffness[i] * at(x, i).first;
    return value(x);
  }
  drape::Stencils stencils() const override {
    return Eigen::Map<const Eigen::VectorXi>(vertices_.data(), static_cast<int>(vertices_.size()));
  }
  // The barrier is convex: nothing to project.
  void add_hessian(const drape::Positions& x, drape::Projection, drape::BlockSink& sink) const override {
    for (std::size_t k = 0; k < vertices_.size(); ++k) {
      const int i = vertices_[k];
      const double block[9] = {0, 0, 0, 0, 0, 0, 0, 0, floor_.stiffness[i] / floor_.dhat * at(x, i).second};
      sink.add(static_cast<int>(k), 0, 0, block);
    }
  }
  int contact_count() const override { return static_cast<int>(vertices_.size()); }
  double smallest_gap() const override { return smallest_gap_; }
  std::unique_ptr<drape::FrictionEnergy> friction(const drape::Positions&,
                                                  const drape::TangentialDisplacements&) const override {
    return nullptr;
  }

 private:
  drape::Derivatives at(const drape::Positions& x, int i) const {
    return drape::barrier(floor_.gap(x, i) / floor_.dhat);
  }

  const Floor& floor_;
  std::vector<int> vertices_;
  double smallest_gap_ = std::numeric_limits<double>::infinity();
};

/// A step may use up 90 % of a vertex's gap.
class FloorCandidates : public drape::CollisionCandidates {
 public:
  FloorCandidates(const Floor& floor, drape::Positions x0, drape::Positions x1)
      : floor_(floor), x0_(std::move(x0)), x1_(std::move(x1)) {}

  drape::StepLimit max_step() const override {
    drape::StepLimit limit;
    for (int i = 0; i < x0_.rows(); ++i) {
      const double gap = floor_.gap(x0_, i), descent = x0_(i, 2) - x1_(i, 2);
      if (limit.fraction * descent > 0.9 * gap)
        limit = {0.9 * gap / descent, "cloth vertex " + std::to_string(i) + " and the floor"};
    }
    return limit;
  }
  std::unique_ptr<drape::Collisions> build_collisions(const drape::Positions& x) const override {
    return std::make_unique<FloorCollisions>(floor_, x);
  }

 private:
  const Floor& floor_;
  drape::Positions x0_, x1_;
};

class BoundFloor : public drape::BoundContact {
 public:
  explicit BoundFloor(Floor floor) : floor_(std::move(floor)) {}

  std::unique_ptr<drape::CollisionCandidates> build_candidates(const drape::Positions& x0,
                                                               const drape::Positions& x1) const override {
    return std::make_unique<FloorCandidates>(floor_, x0, x1);
  }
  std::vector<drape::Intersection> intersections(const drape::Positions& x) const override {
    std::vector<drape::Intersection> found;
    for (int i = 0; i < x.rows(); ++i)
      if (floor_.gap(x, i) <= 0)
        found.push_back({"cloth vertex " + std::to_string(i), "the floor", x.row(i).transpose()});
    return found;
  }
  std::vector<drape::TriangleMesh> obstacles() const override { return {}; }

 private:
  Floor floor_;
};

/// A floor that vertices rest on, without friction.
class FloorModel : public drape::ContactModel {
 public:
  struct Parameters {
    double height = 0, dhat = 1e-3;

    static void declare(drape::Declaration<Parameters>& d) {
      d.add("height", &Parameters::height)
          .unit("m")
          .at_least(-1e3)
          .at_most(1e3)
          .description("z of the floor");
      d.add("dhat", &Parameters::dhat)
          .unit("m")
          .at_least(1e-9)
          .at_most(1)
          .description("d̂: the barrier acts on smaller gaps");
    }
  };

  explicit FloorModel(const Parameters& parameters) : p_(parameters) {}

  std::unique_ptr<drape::BoundContact> bind(const drape::Level& level,
                                            const drape::Material& material) const override {
    return std::make_unique<BoundFloor>(
        Floor{p_.height, p_.dhat, drape::contact_stiffness(material) * level.vertex_area});
  }

 private:
  Parameters p_;
};

}  // namespace

DRAPE_PLUGIN(registry) {
  registry.add<drape::ContactModel, FloorModel>("floor", "A horizontal floor under the vertices.");
}
