// A contact model that sees a floor and does nothing about it.

#include <limits>

#include "core/kernel/interfaces/contact_model.h"
#include "core/kernel/plugin/plugin.h"

namespace {

using drape::Positions;

struct NoContacts final : drape::Collisions {
  int contact_count() const override { return 0; }
  double smallest_gap() const override { return std::numeric_limits<double>::infinity(); }
  double value(const Positions&) const override { return 0; }
  double add_gradient(const Positions&, Positions&) const override { return 0; }
  drape::Stencils stencils() const override { return drape::Stencils(0, 1); }
  void add_hessian(const Positions&, drape::Projection, drape::BlockSink&) const override {}
};

struct Anywhere final : drape::CollisionCandidates {
  drape::StepLimit max_step() const override { return {}; }
  std::unique_ptr<drape::Collisions> build_collisions(const Positions&) const override {
    return std::make_unique<NoContacts>();
  }
};

struct BoundBlind final : drape::BoundContact {
  double height = 0;
  explicit BoundBlind(double height_in) : height(height_in) {}
  std::unique_ptr<drape::CollisionCandidates> build_candidates(const Positions&,
                                                               const Positions&) const override {
    return std::make_unique<Anywhere>();
  }
  std::vector<drape::Intersection> intersections(const Positions& x) const override {
    Eigen::Index lowest = 0;
    if (x.col(2).minCoeff(&lowest) > height) return {};
    return {{"cloth vertex " + std::to_string(lowest), "floor: plane", x.row(lowest).transpose()}};
  }
};

struct Blind final : drape::ContactModel {
  double height = 0;
  static void declare(drape::Declaration<Blind>& d) {
    d.add("height", &Blind::height, "of the floor").unit("m").source("test");
  }
  std::unique_ptr<drape::BoundContact> bind(const drape::Level&, const drape::Material&) const override {
    return std::make_unique<BoundBlind>(height);
  }
};

}  // namespace

DRAPE_PLUGIN(registry) {
  registry.add<drape::ContactModel, Blind>("blind", "A floor that holds nothing up.");
}
